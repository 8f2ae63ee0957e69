"""One reader: whatever is wrong with a file of any kind is told with its line and key, soon, and all of it at once."""

import os
import sys
import tracemalloc

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.data.text import LARGEST_FILE_BYTES
from pvlvrt_compliance.errors import PvlvrtError, UsageError
from pvlvrt_compliance.scenario.files import load_events

MANY_DIGITS = "9" * 5000
TOO_LARGE = "not TOML: a whole number of more than 64 bits, which TOML does not have"
TOO_DEEP = "nested too deeply, more than 32 levels"


@pytest.mark.parametrize(("mark", "newline"), [("", "\n"), ("\ufeff", "\n"), ("", "\r\n"), ("\ufeff", "\r\n")])
def test_files_of_other_systems_are_read(kind, file, mark, newline):
    """A byte-order mark and the line ends of Windows change nothing of what is read."""
    file.write_bytes(kind.sound.encode())
    plain = kind.load(str(file))
    file.write_bytes((mark + kind.sound.replace("\n", newline)).encode())
    assert kind.load(str(file)) == plain


@pytest.mark.parametrize(("mark", "newline"), [("", "\n"), ("\ufeff", "\r\n")])
def test_line_key_what_is_allowed_and_what_was_meant(kind, problems, mark, newline):
    """All mistakes are told at once, each with its line, its key, what is allowed and the key that was meant."""
    assert set(problems(mark + kind.wrong.replace("\n", newline))) == set(kind.problems)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_utf_16_is_named(kind, problems, encoding):
    """What Windows calls Unicode is named, with or without its mark, and what to do."""
    assert problems(kind.sound.encode(encoding)) == ["1: not UTF-8 text: it is UTF-16; save it as UTF-8"]


@pytest.mark.parametrize("encoding", ["utf-32", "utf-32-le", "utf-32-be"])
def test_utf_32_is_named(kind, problems, encoding):
    """So is the encoding whose mark begins as that of UTF-16."""
    assert problems(kind.sound.encode(encoding)) == ["1: not UTF-8 text: it is UTF-32; save it as UTF-8"]


def test_a_character_of_another_encoding_is_found(problems):
    """A letter in Latin-1 is told by its line and place."""
    assert problems(b'a = 1\nb = "\xe9"\n') == ["2: not UTF-8 text: byte 11 cannot be decoded; save it as UTF-8"]


def test_the_largest_file_is_read(kind, file):
    """A file of exactly the limit is read."""
    file.write_bytes(kind.sound.encode().ljust(LARGEST_FILE_BYTES - 1, b"#") + b"\n")
    assert kind.load(str(file)) is not None


def test_a_larger_file_is_not_read(kind, file, problems):
    """One byte more is refused with the limit; of 10 MB, no more is read than it takes to refuse them."""
    said = problems(b"# " + b"x" * (LARGEST_FILE_BYTES - 1))
    assert len(said) == 1
    assert said[0].startswith(" larger than 1 MiB; a")
    file.write_bytes(b"x" * 10_000_000)
    tracemalloc.start()
    with pytest.raises(PvlvrtError, match="larger than 1 MiB"):
        kind.load(str(file))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3_000_000


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (f"a = [\n{'[' * 32}{']' * 32}]", f"2: a: {TOO_DEEP}"),
        (f"a = 1\n[b]\nc = {'{ d = ' * 32}1{' }' * 32}", f"3: b: {TOO_DEEP}"),
        (f"a = 1\nb = {'[' * 5000}{']' * 5000}", f"2: b: not TOML: {TOO_DEEP}"),
        (f"a = ']'\nb.c = {'{ d = ' * 5000}1{' }' * 5000}", f"2: b: not TOML: {TOO_DEEP}"),
        (f"a = 1\nb = {'[' * 20000}", f"2: b: not TOML: {TOO_DEEP}"),
        (f"a = 1\n{'.'.join('b' * 33)} = 1", "2: a key of too many parts, more than 32"),
        (f"a = 1\n{'.'.join('b' * 200_000)} = 1", "2: a key of too many parts, more than 32"),
    ],
)
def test_depth_is_limited(problems, text, problem):
    """What is nested beyond any use is told with its line, its key and the limit, however deep it goes."""
    assert problems(text) == [problem]


def test_depth_within_the_limit_is_no_problem_of_its_own(problems):
    """Of 32 levels, the key is judged, not the depth."""
    assert not any("deep" in line for line in problems(f"a = {'[' * 32}{']' * 32}"))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (f"a = {MANY_DIGITS}", f"1: a: {TOO_LARGE}"),
        (f"a = '{MANY_DIGITS}'\n[b]\nc = {{ d = [1,\n -{MANY_DIGITS}] }}", f"4: b.c.d[1]: {TOO_LARGE}"),
        (f"{MANY_DIGITS} = 1\n# {MANY_DIGITS}\n[[b]]\nc = {MANY_DIGITS}", f"4: b[0].c: {TOO_LARGE}"),
        (f"a = {MANY_DIGITS}.0\nb = {'1_' * 2500}1 # c", f"2: b: {TOO_LARGE}"),
        (f"a = 0x{'f' * 5000}", f"1: a: {TOO_LARGE}"),
        ("a = 9223372036854775808", f"1: a: {TOO_LARGE}"),
        ("a = -9223372036854775809", f"1: a: {TOO_LARGE}"),
    ],
)
def test_whole_numbers_are_of_64_bits(problems, text, problem):
    """A whole number beyond those that TOML has is told with its line and key, however many digits it has."""
    assert problems(text) == [problem]


@pytest.mark.parametrize("value", ["9223372036854775807", "-9223372036854775808", MANY_DIGITS + ".0"])
def test_the_largest_whole_numbers_are_read(problems, value):
    """Up to the limit, and of a number with a fraction, nothing is said of bits."""
    assert not any("bits" in line for line in problems(f"a = {value}"))


def test_other_languages_are_named(kind, problems):
    """YAML and JSON are told from TOML that is wrong."""
    assert problems("---\na: 1\n") == [f"1: not TOML: this looks like YAML; {kind.many} are TOML"]
    assert problems('{"a": 1}') == [f"1: not TOML: this looks like JSON; {kind.many} are TOML"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("a = 1\n[b\n", "2: not TOML: "),
        ("a = 1\nb = \n", "2: b: not TOML: "),
        ("a = '\u2028\x85'\nb = 'c\n", "2: b: not TOML: "),
        ("a = 1\n" + " " * 500_000 + "?", "2: not TOML: "),
        ("a = 1\na = 2\n\n", "a key or table that is there already"),
    ],
)
def test_syntax_errors_have_their_line(problems, text, problem):
    """What is no TOML is told with its line, counted as an editor does, and its key."""
    (said,) = problems(text)
    assert problem in said


def test_names_of_any_length_are_shortened(problems):
    """A key of a million letters is no line of a million letters, whether it is unknown or written twice."""
    name = "k" * 500_000
    for text in (f"{name} = 1", f"[{name}]\n[{name}]", f"'{name}' = \n"):
        said = problems(text)
        assert any("kkk..." in line or "kk'..." in line for line in said)
        assert max(map(len, said)) < 1000


def test_all_control_characters_are_told(problems):
    """What a terminal would act on is refused, in texts and in keys, each with its line or that of its table."""
    said = problems('[a]\nb = "\\u001b[2J"\nc = "x\\ty\\nz"\nd = ["\\u0000"]\n"e\\n" = 1\n')
    assert said == [
        "2: a.b: a text must not have control characters",
        "4: a.d[0]: a text must not have control characters",
        "1: a: a key must not have control characters",
    ]
    assert problems('"\x1b[2J" = 1') != []
    assert "\x1b" not in "".join(problems('"\x1b[2J" = 1'))


def test_of_many_problems_the_first_are_listed(kind, file):
    """All are counted, a hundred are listed, and it is said how many more there are."""
    file.write_text("".join(f"a{index} = 1\n" for index in range(300)) + kind.sound, "utf-8")
    with pytest.raises(PvlvrtError) as caught:
        kind.load(str(file))
    head, *lines, last = str(caught.value).splitlines()
    count = int(head.removeprefix(f"{file}: ").split()[0])
    assert count >= 300
    assert len(lines) == 100
    assert last == f"  and {count - 100} more"


def special(what, path):
    """Make something at a path that is no ordinary file."""
    match what:
        case "folder":
            path.mkdir()
        case "pipe":
            os.mkfifo(path)
        case "device":
            path.symlink_to("/dev/zero")
        case "loop":
            path.symlink_to(path)


@pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and links of POSIX")
@pytest.mark.parametrize("what", ["folder", "pipe", "device", "loop", "nothing"])
def test_only_ordinary_files_are_opened(kind, file, what):
    """Whatever else a path leads to is refused at once and named; no pipe is waited for, no device read."""
    special(what, file)
    with pytest.raises(UsageError) as caught:
        kind.load(str(file))
    said = str(caught.value)
    assert str(file) in said
    assert ("" if what in {"loop", "nothing"} else f"it is a {what}") in said
    assert "cannot be read: " in said or "no profile file at" in said


def test_a_path_that_no_file_has(kind):
    """A path with a zero in it is a usage error, too."""
    with pytest.raises(UsageError, match=r"a\\?.*b\.toml"):
        kind.load("a\0b.toml")


@pytest.mark.parametrize("value", ["'0'", "true", "[0]", "1979-05-27", "nan", "inf"])
def test_numbers_of_events_are_numbers(tmp_path, value):
    """In a file of events as in a profile, no number is made of a text or a flag."""
    path = tmp_path / "events.toml"
    path.write_text(f'[[events]]\nkind = "phase_jump"\nt_s = {value}\nangle_deg = 1\n', "utf-8")
    with pytest.raises(UsageError, match=r"events\.toml:3: events\[0\]\.t_s: must be a (finite )?number, not "):
        load_events(str(path))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("kind = 'phase_jmp'", "kind 'phase_jmp' is unknown; did you mean \"phase_jump\"? Allowed: sag, voltage_prof"),
        ("kind = 3", "kind '3' is unknown; allowed: sag, voltage_profile, "),
        ("t_s = 0", "kind is missing; allowed: sag, voltage_profile, phase_jump, "),
    ],
)
def test_kinds_of_events(tmp_path, text, problem):
    """A kind that is misspelt or missing is told with the kinds there are."""
    path = tmp_path / "events.toml"
    path.write_text(f"[[events]]\n{text}\n", "utf-8")
    with pytest.raises(UsageError) as caught:
        load_events(str(path))
    assert f"{path}:1: events[0]: {problem}" in str(caught.value)


@draws(60, HealthCheck.function_scoped_fixture)
@given(st.text(max_size=200) | st.text("[]{}='\"\n.,a1\\# ", max_size=60))
def test_any_text_is_answered(kind, file, text):
    """Any text at all is read or refused, never a traceback."""
    file.write_text(text, "utf-8", errors="replace")
    try:
        kind.load(str(file))
    except PvlvrtError as error:
        said = str(error)
    else:
        said = str(file)
    assert str(file) in said
