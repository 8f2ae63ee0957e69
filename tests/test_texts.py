"""Texts of others: what is made of them, and names that need not be text."""

import io
import re
import shlex
import subprocess
from pathlib import Path

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

import pvlvrt_compliance
import worst
from pvlvrt_compliance.texts import (
    LONGEST,
    LONGEST_ID,
    LONGEST_NAME,
    MOST_LINES,
    all_printable,
    each_line,
    harmless,
    identity,
    one_line,
    printable,
    shell_word,
    shortened,
    write_any_name,
)


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


@given(text=st.text(max_size=30) | st.text(alphabet="\r\n\t:#[a\x1b\u2028\ud800", max_size=60))
@example(text="\r\n" * 10)
def test_what_has_passed_passes_again_unchanged(text):
    """At any length; and what comes of it is seen."""
    for longest in (40, 1000):
        for once in (printable(text, longest), one_line(text, longest)):
            worst.seen(once)
            assert len(once) <= longest
            assert printable(once, longest) == once
        assert "\n" not in one_line(text, longest)
        assert one_line(one_line(text, longest), longest) == one_line(text, longest)
    assert identity(identity(text)) == identity(text)


@given(text=st.text(alphabet=st.characters(categories=["L", "N", "P", "S"], exclude_characters=":#")))
def test_letters_of_every_script_stay(text):
    """All that has a width of its own is as it was, fillers aside, which look like nothing."""
    assume(not any(each in "\u115f\u1160\u3164\uffa0" for each in text))
    assert printable(text, None) == text == one_line(text, None)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("a\r\nb\rc\u2028d\x85e", "a\nb\nc\nd\ne"),
        ("a\tb\x1b[1m\x7f", r"a   b\x1b[1m\x7f"),
        ("\u202eabc\u2066\u200b\ufeff", r"\u202eabc\u2066\u200b\ufeff"),
        ("\U000e0041\U0001fffe", r"\U000e0041\U0001fffe"),
        ("::error::x\n  ::y\nz::w", ": :error::x\n  : :y\nz::w"),
        ("##[error]a ##vso[b]c ##d", "## [error]a ## vso[b]c ##d"),
        ("1 < 2 & Ω 测试 ä \u00a0 ❤\ufe0f", "1 < 2 & Ω 测试 ä \u00a0 ❤\ufe0f"),
    ],
)
def test_what_is_made_of_a_text(text, kept):
    """Ends of lines, tabs, what cannot be seen, and commands of CI services."""
    assert printable(text) == kept


def test_a_cut_says_how_much_there_was():
    """Of a text, of a line, of a listing."""
    assert printable("x" * 9000).endswith("x... (9000 characters)")
    assert len(printable("x" * 9000)) == LONGEST
    assert one_line("y\n" * 9000).endswith("... (18000 characters)")
    assert each_line("z\n" * 300).endswith("z\n... (301 lines)")
    assert shortened("a" * 50, 40) == f"{'a' * 21}... (50 characters)"
    assert shortened("a" * 40, 40) == "a" * 40


def test_the_page_says_how_long_a_text_may_be():
    """docs/reports.md has the bounds that hold."""
    page = (Path(__file__).parents[1] / "docs" / "reports.md").read_text("utf-8")
    assert (
        f"more than {LONGEST} characters; of a name or a title {LONGEST_NAME}, of an id or a check {LONGEST_ID}" in page
    )
    assert f"an error of more than {MOST_LINES} lines" in page


def test_names_that_are_cut_stay_apart():
    """Two long ids that begin alike are two ids."""
    first, second = (identity(f"{'x' * 5000}{n}") for n in "12")
    assert first != second
    assert len(first) <= LONGEST_ID


@pytest.mark.parametrize("made", [b"::error::x\n" * 200_000, b" " * 400_000 + b"::", b"\n" * 400_000, b"#" * 400_000])
def test_a_long_text_takes_no_longer(made):
    """Every character is looked at a few times at most: megabytes of a hostile text are harmless within seconds."""
    text = made.decode()
    worst.seen(harmless(text))
    assert len(printable(text)) <= LONGEST
    assert len(one_line(text)) <= LONGEST


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
    if printable(word) == one_line(word) == word:
        assert shell_word(word) == shlex.quote(word)


OTHER_QUESTIONS = {
    "report/pdf/characters.py": "which characters the fonts have",
    "controllers/install_from.py": "what a line of a requirements file may be",
    "study/baseline/text.py": "which names are written as JSON",
    "scenario/events.py": "which names of files are refused",
}
"""Modules that ask what characters are for another reason than to show them."""


def test_one_place_knows_what_can_be_seen():
    """No other module of the package looks at characters to clean a text of its own accord."""
    folder = Path(pvlvrt_compliance.__file__).parent
    asking = {
        file.relative_to(folder).as_posix()
        for file in folder.rglob("*.py")
        if re.search(r"isprintable|unicodedata|surrogatepass.*replace|\\u202e", file.read_text("utf-8"))
    }
    assert asking - {"texts.py"} == set(OTHER_QUESTIONS)
