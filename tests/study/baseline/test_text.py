"""The file of a baseline: written and read back, and told what is wrong with it."""

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from baselines import HEAD, baseline_file, held, one, verdict
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.results.changes import Key
from pvlvrt_compliance.study.baseline.entries import Baseline, Entry, entry_of, half_a_unit
from pvlvrt_compliance.study.baseline.reading import read_baseline
from pvlvrt_compliance.study.baseline.text import parsed, written
from pvlvrt_compliance.study.baseline.updating import updated

NAMES = st.text(min_size=0, max_size=60)
PLAIN = st.text(st.characters(exclude_categories=["Cc", "Cs"], exclude_characters="\ufffe\uffff"), max_size=60)
REASONS = PLAIN.map(str.strip)
COMMENTS = st.lists(PLAIN.map(lambda text: f"# {text}".strip()), max_size=2).map(tuple)
MARGINS = st.decimals(-(10**9), 10**9, places=3, allow_nan=False) | st.integers(-100, 100).map(Decimal)


@st.composite
def entries(draw):
    """Any entry that the model allows."""
    number = draw(st.sampled_from(["", " (2)", " (10)"]))
    key = Key(draw(NAMES), draw(NAMES) + number)
    margin = draw(st.none() | MARGINS)
    unit = "" if margin is None else draw(st.sampled_from(["", "pu", "%"]) | NAMES)
    status = draw(st.sampled_from([Status.FAIL, Status.PASS]))
    return Entry(key, status, margin, unit, draw(REASONS), draw(COMMENTS))


@given(st.lists(entries(), max_size=6, unique_by=lambda entry: entry.key), COMMENTS)
def test_what_is_written_is_read_back(found, below):
    """Whatever the names, units, reasons and comments are; and written again it is the same bytes."""
    baseline = Baseline({entry.key: entry for entry in found}, below)
    text = written(baseline)
    read, problems = parsed(text, "b.txt")
    assert problems == []
    assert read.entries == baseline.entries
    assert read.below == baseline.below
    assert written(read) == text


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused(text):
    """Nothing that somebody may write breaks the reader; each problem has its line."""
    _, problems = parsed(text, "b.txt")
    assert all(problem.startswith("b.txt:") for problem in problems)


def test_lines_are_sorted_and_stand_in_columns():
    """By test and check, the tenth verdict of a check behind the second; a long name moves no other line."""
    names = ["p.b", "p.a", "p.a-test-with-a-name-that-has-no-room-in-its-column"]
    found = [Entry(Key(name, "x"), Status.FAIL, Decimal("-0.086"), "pu", "why") for name in names]
    found += [Entry(Key("p.a", f"x ({n})"), Status.PASS, Decimal(n), "s") for n in (10, 2)]
    lines = written(Baseline({entry.key: entry for entry in found})).splitlines()[4:]
    assert [line.split()[:3] for line in lines] == [
        ["p.a", "x", "fail"],
        ["p.a", "x", "(2)"],
        ["p.a", "x", "(10)"],
        [names[2], "x", "fail"],
        ["p.b", "x", "fail"],
    ]
    assert lines[0].index("fail") == lines[4].index("fail")
    assert lines[0].index("# why") == lines[4].index("# why")
    without = written(Baseline({entry.key: entry for entry in found if entry.key.test != names[2]}))
    assert without.splitlines()[4:] == [*lines[:3], lines[4]]


def test_a_line_reads_as_the_report_does():
    """The margin has the digits and the unit of the report."""
    entry = entry_of(Key("p.VD1", "current_limit"), verdict("fail", -0.0863034, limit=1.02, unit="pu"))
    line = written(Baseline({entry.key: entry})).splitlines()[-1]
    assert line.split() == ["p.VD1", "current_limit", "fail", "-0.086", "pu"]


@pytest.mark.parametrize(("limit", "unit"), [(0.004, "pu"), (1.0, "kvar"), (1e6, "kW"), (60.0, "ms"), (0.5, "%")])
def test_rounding_is_small_beside_the_limit(limit, unit):
    """Where the digits of a report are coarse, there are more of them."""
    entry = entry_of(Key("p.t", "x"), verdict("fail", -limit / 3, limit=limit, unit=unit))
    assert abs(float(entry.margin) + limit / 3) <= half_a_unit(entry.margin) <= 0.001 * limit


def test_what_a_change_cannot_be_measured_of_has_no_margin():
    """Without a limit there is nothing to take a share of."""
    assert entry_of(Key("p.t", "x"), verdict("fail", -1.0, limit=None)).margin is None


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("p.t x", "2 of at least 3 words; a line is: TEST CHECK VERDICT MARGIN # REASON"),
        ("p.t x fial -1 pu", "verdict 'fial' is unknown; allowed are fail, pass; did you mean \"fail\"?"),
        ("p.t x error", "verdict 'error' is unknown; allowed are fail, pass"),
        ("p.t x (2)", "verdict '' is unknown"),
        ("p.t x fail -0,086 pu", "margin '-0,086' is not a number; allowed is one with its unit"),
        ("p.t x fail nan pu", "margin 'nan' is not a number"),
        (f"p.t x fail 1{'0' * 400} pu", "is not a number"),
        ("p.t x fail -1 pu ticket 42", "'ticket' is too much"),
        ('"p.t x fail -1', "a quotation mark that nothing closes"),
        (r'"p.\q" x fail', "not a text as JSON has it"),
        ("p.a x fail -1 pu", "x in p.a stands in line 3 already; allowed is one line each"),
        ("<<<<<<< HEAD", "a marker of a merge conflict"),
        ("=======", "a marker of a merge conflict"),
        (">>>>>>> theirs", "a marker of a merge conflict"),
        ("||||||| base", "a marker of a merge conflict"),
        ("p.t x fail -1 pu # \x1b[31m", "has a control character"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(tmp_path, line, said):
    """Every problem of the file at once, each with file, line and what is allowed."""
    file = tmp_path / "b.txt"
    file.write_text(f"{HEAD}p.a x fail -1 pu\n{line}\n\np.b x maybe\n", "utf-8")
    with pytest.raises(UsageError) as caught:
        read_baseline(str(file))
    head, first, second = str(caught.value).splitlines()
    assert head == f"--baseline {file}: 2 problems"
    assert first.startswith(f"  {file}:4: ")
    assert said in first
    assert second.startswith(f"  {file}:6: verdict 'maybe' is unknown")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", 'b.txt:1: no baseline: the first line must be "# pvlvrt-baseline 1"'),
        (b"p.t x fail\n", "b.txt:1: no baseline"),
        (b"# pvlvrt-baseline 2\n", "b.txt:1: format 2 is not known to this version of the program, which reads 1"),
        (b"# pvlvrt-baseline x\n", "b.txt:1: no baseline"),
        (HEAD.encode() + b"p.t x fail # \xff\n", "b.txt:3: not UTF-8 text"),
        (HEAD.encode("utf-16"), "b.txt:1: not UTF-8 text: it is UTF-16"),
        (HEAD.encode() + b"#" * (1 << 20), "b.txt: larger than 1 MiB; a baseline is a few kilobytes"),
    ],
)
def test_what_is_no_baseline_is_refused(tmp_path, content, said):
    """By its first line, its encoding or its size."""
    file = tmp_path / "b.txt"
    file.write_bytes(content)
    with pytest.raises(UsageError) as caught:
        read_baseline(str(file))
    assert said in str(caught.value)


def test_a_file_that_is_not_there_is_refused():
    """With its name, and how one begins that knows nothing."""
    with pytest.raises(UsageError, match=r"--baseline nowhere/b\.txt: cannot be read: No such file") as caught:
        read_baseline("nowhere/b.txt")
    line = str(caught.value).partition("'")[2].rstrip("'")
    assert parsed(f"{line}\n", "b.txt") == (Baseline({}), [])


@pytest.mark.parametrize("changed", [lambda text: text.replace("\n", "\r\n"), lambda text: f"\ufeff{text}"])
def test_ends_of_lines_and_a_byte_order_mark_are_no_matter(tmp_path, changed):
    """The same entries, and the same digest."""
    plain, other = tmp_path / "a.txt", tmp_path / "b.txt"
    text = f"{HEAD}\n\np.t\tx  fail -1 pu#why\n   \n"
    plain.write_bytes(text.encode())
    other.write_bytes(changed(text).encode())
    found = read_baseline(str(other))
    assert found.baseline.entries == {
        Key("p.t", "x"): Entry(Key("p.t", "x"), Status.FAIL, Decimal("-1"), "pu", "why"),
    }
    assert (found.baseline, found.digest) == read_baseline(str(plain))[:0:-1]


def test_no_name_of_a_file_reaches_a_terminal_as_it_is():
    """What a terminal would act on is a question mark in all that is told."""
    run = held(one(verdict("pass", 1.0)), r'p.t x fail -1.0 "\u001b[31m"', r'"p.\u001b" x fail', is_gone=lambda _: True)
    told = [note.in_words for note in (*run.baseline.better, *run.baseline.gone)]
    update = updated(baseline_file(r'"p.\u001b" x fail -1 "\u0007"').baseline, one(verdict()), prune=True)
    told += [step.in_words for step in update.steps]
    assert len(told) == 4
    assert all(line.isprintable() for line in told)
