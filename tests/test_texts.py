"""Names that need not be text."""

import io
import shlex
import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.texts import all_printable, printable, shell_word, write_any_name


@given(data=st.binary(max_size=20))
def test_whatever_a_name_holds_can_be_printed(data):
    """Bytes that are no text are spelled, text stays as it is."""
    name = data.decode("utf-8", "surrogateescape")
    spelled = printable(name)
    spelled.encode("utf-8")
    if spelled == name:
        assert name.encode() == data


@pytest.mark.parametrize(("name", "spelled"), [("a\udcffb", r"a\xffb"), ("ü€", "ü€"), ("\ud800", r"\ud800")])
def test_spelling(name, spelled):
    """A byte as in C, any other half of a character by its code."""
    assert printable(name) == spelled


@pytest.mark.parametrize(
    ("encoding", "written"), [("utf-8", b"\xff \xc3\xa9"), ("latin-1", b"\xff \xe9"), ("ascii", b"\xff ?")]
)
def test_a_stream_of_any_encoding(encoding, written):
    """A name's bytes are written as they are, and what a stream cannot hold costs a mark, not the command."""
    raw = io.BytesIO()
    stream = io.TextIOWrapper(raw, encoding=encoding)
    write_any_name(stream)
    stream.write("\udcff é")
    stream.flush()
    assert raw.getvalue() == written


def test_data_of_any_depth():
    """Keys and values alike."""
    assert all_printable({"\udcff": ["\udcfe", ("\udcfd", 1.5)]}) == {r"\xff": [r"\xfe", [r"\xfd", 1.5]]}


@pytest.mark.parametrize("data", [b"\xff", b"it's \xff\n", b"\\\xfff", b"$\xff`"])
def test_a_shell_reads_the_bytes_back(data):
    """A word with bytes that are no text is one that bash, zsh and ksh know."""
    word = shell_word(data.decode("utf-8", "surrogateescape"))
    word.encode("ascii")
    said = subprocess.run(["bash", "-c", f"printf %s {word}"], capture_output=True, check=True).stdout
    assert said == data


@given(word=st.text(max_size=10))
def test_text_is_quoted_as_ever(word):
    """Everything else is quoted for any shell."""
    if printable(word) == word:
        assert shell_word(word) == shlex.quote(word)
