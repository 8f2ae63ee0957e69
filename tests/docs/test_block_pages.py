"""The pages of the blocks: nothing is missing, and what they say of code, parameters and tests holds."""

import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.simulation.parameters import parameter_names
from validation.blocks import __main__ as command
from validation.blocks import numbers, page, svg
from validation.blocks.parameters import KNOWN, allowed_of, field_of, unit_of
from validation.places import DOCS, ROOT

PAGES = page.pages()
ROOMS = ("control", "plant", "hardware")
ROW = re.compile(r"^\| `([\w.]+)` \| [^|]* \| ([^|]*) \| ([^|]*) \|", re.MULTILINE)


def all_made_of(kind: str) -> Counter[str]:
    """What the parts of a kind are made of, on all pages, by how often."""
    return Counter(name for path in PAGES for name in page.made_of(path.read_text("utf-8"), kind))


def blocks() -> set[str]:
    """Every file of the three rooms that is a block: all but parameter models and what only marks a folder."""
    files = [file for room in ROOMS for file in (ROOT / "pvlvrt_compliance" / room).rglob("*.py")]
    return {file.relative_to(ROOT).as_posix() for file in files if file.name not in {"__init__.py", "parameters.py"}}


def parameter_rows(path: Path) -> list[tuple[str, str, str]]:
    """Name, default and unit of each line of a page's tables of parameters."""
    parts = (body for kind, _, body in page.MADE.findall(path.read_text("utf-8")) if kind == "parameters")
    return [row for body in parts for row in ROW.findall(body)]


def test_what_is_allowed_is_said():
    """Every number has its range in the table, of a list the range of each place."""
    assert allowed_of("plant.filter_inductance_h") == "1e-07 to 1"
    assert allowed_of("protection.undervoltage_curve") == "0 to 3600; 0 to 10"
    assert allowed_of("controller.precision") == ""
    shown = "".join(path.read_text("utf-8") for path in PAGES)
    for name in parameter_names():
        assert f"| {unit_of(name)} | {allowed_of(name)} |" in next(
            line for line in shown.splitlines() if line.startswith(f"| `{name}` |")
        )


def value_of(cell: str) -> object:
    """Default as a table shows it, read back."""
    words = {"none": None, "true": True, "false": False}
    if cell in words:
        return words[cell]
    numbers_in = [float(x) for x in re.findall(r"[-\d.e+]+", cell)] if re.fullmatch(r"[-\d.e+(), ]+", cell) else []
    return numbers_in or cell


def test_every_block_has_one_page():
    """Each file of control/, plant/ and hardware/ is the code of exactly one page."""
    named = all_made_of("code")
    assert blocks() - set(named) == set()
    assert {name for name, count in named.items() if count > 1} == set()
    assert {name for name in named if not (ROOT / name).is_file()} == set()


def test_every_parameter_stands_on_one_page():
    """All that `--set` reaches is in exactly one table, and nothing else is."""
    shown = Counter(name for path in PAGES for name, _, _ in parameter_rows(path))
    assert shown == Counter(parameter_names())
    assert shown == all_made_of("parameters")


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(DOCS).as_posix())
def test_defaults_are_those_of_the_program(path: Path):
    """The number in the table is the one that a run without `--set` has, to the digits shown."""
    for name, cell, _ in parameter_rows(path):
        default = field_of(name).default
        if isinstance(default, (int, float)) and not isinstance(default, bool):
            default = [default]
        found = value_of(cell)
        if isinstance(default, (list, tuple)):
            assert found == pytest.approx(np.ravel(default).tolist(), rel=1e-5), name
        else:
            assert found == default, name


def test_where_a_default_comes_from():
    """A model that says a number is not in the paper is not contradicted, and every number has a source and a unit."""
    assert list(KNOWN) == parameter_names()
    for name, known in KNOWN.items():
        field = field_of(name)
        assert known.source, name
        if "not in the paper" in (field.description or ""):
            assert known.source == "chosen, not in the paper", name
        if isinstance(field.default, float):
            assert unit_of(name), name


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(DOCS).as_posix())
def test_code_parameters_and_tests_are_up_to_date(path: Path):
    """What is made of sources is what they say now; numbers are computed by `python -m validation.blocks --check`."""
    for kind, names, body in page.MADE.findall(path.read_text("utf-8")):
        if kind != "numbers":
            assert "\n".join(page.lines(kind, names.split())) + "\n" == body, kind


def test_every_number_and_figure_is_shown():
    """No table is computed for nothing, and every page has a figure and tests."""
    assert set(all_made_of("numbers")) == set(numbers.ROWS)
    for path in PAGES:
        text = path.read_text("utf-8")
        assert page.made_of(text, "tests"), path
        assert "![" in text or path.name == "precision.md", path


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(DOCS).as_posix())
def test_no_symbol_begins_an_emphasis(path: Path):
    """The site would take what stands between the stars of P* and Q* for emphasis: in prose they are escaped."""
    prose = re.sub(r"^```.*?^```|^    .*?$|`[^`]*`", "", page.MADE.sub("", path.read_text("utf-8")), flags=re.M | re.S)
    assert re.findall(r"(?<![\\\w])[PQiv]\*(?!\*).*", prose) == []


def test_a_test_that_is_gone_is_noticed(tmp_path):
    """Naming a test that is not in its file is an error, and one that is there gives its sentence."""
    file = tmp_path / "test_x.py"
    file.write_text('def test_it():\n    """It *works*,\n    with `a_name`.\n\n    More.\n    """\n', "utf-8")
    assert page.sentences(file, set()) == [r"It \*works\*, with `a_name`."]
    with pytest.raises(KeyError, match="test_that"):
        page.sentences(file, {"test_that"})


def test_a_figure_is_drawn_where_its_numbers_are():
    """A straight line from corner to corner of a logarithmic panel passes its middle at the geometric mean."""
    line = svg.curve("line & co", [1, 10, 100], [0, 1, 2])
    dots = svg.curve("dots", [10], [1], dots=True, like=0)
    text = svg.render(svg.Figure("x.svg", "a < b", (svg.Axes("x", "y", (line, dots), log=True),)))
    (path,) = re.findall(r'<path d="M([\d. L]+)" stroke="#004488" stroke-width="1.4" fill', text)[-1:]
    (x0, y0), (x1, y1), (x2, y2) = (map(float, point.split()) for point in path.split("L"))
    assert (2 * x1, 2 * y1) == pytest.approx((x0 + x2, y0 + y2), abs=0.2)
    assert f"M{x1:.1f} {y1:.1f}h0" in text
    assert "<title>a &lt; b</title>" in text
    assert "line &amp; co" in text


def test_a_stale_figure_or_page_is_noticed(tmp_path, monkeypatch):
    """Another number is stale, a rounding of the last digit is not, and a file that is not there is missing."""
    monkeypatch.setattr(command, "DOCS", tmp_path)
    file = tmp_path / "x.svg"
    assert command.stale(file, "M1.0 2.0") == ["missing: x.svg"]
    file.write_text("M1.0 2.0", "utf-8")
    assert command.stale(file, "M1.1 2.0") == []
    assert len(command.stale(file, "M1.3 2.0")) == 1
