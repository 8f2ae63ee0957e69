"""All tests of the profile in one run."""

import re
from typing import NamedTuple

import pytest
from lxml import etree

HONEST_FAILURES = {"VD1-full-1", "VD1-full-2", "VD4-full-1", "VD4-full-2"}

# P (kW), Q (kvar) and largest phase current (pu) at 1000 W/m2, from an independent program of the same equations.
AT_FULL_POWER = {
    "VD1": (498, 0, 1.106),
    "VD2": (0, 250, 1.00),
    "VD3": (0, 100, 1.00),
    "VD4": (497, 0, 1.079),
    "VD5": (226, 134, 0.90),
    "VD6": (0, 260, 0.87),
}


class Catalogue(NamedTuple):
    ended: object
    reports: object


@pytest.fixture(scope="module")
def catalogue(command, reports, tmp_path_factory):
    """The one run."""
    folder = tmp_path_factory.mktemp("catalogue") / "out"
    return Catalogue(command("--profile", "iec61400-21", "--output", folder), reports(folder))


@pytest.fixture(scope="module")
def during(catalogue):
    """Measurements of the window `during` by test."""
    return {test["id"]: test["measurements"]["during"] for test in catalogue.reports.json["tests"]}


def test_ids(catalogue):
    """Six drops at two powers, twice each, and the paper's three sags once."""
    drops = [f"VD{n}-{power}-{k}" for n in range(1, 7) for power in ("full", "partial") for k in (1, 2)]
    paper = ["paper-three-phase-90", "paper-phase-c-90", "paper-phase-c-50"]
    assert list(catalogue.reports.verdicts) == drops + paper


def test_status_and_summary(catalogue):
    """Failed checks end with 1, and the last lines say how many."""
    assert (catalogue.ended.status, catalogue.ended.err) == (1, "")
    assert "FAIL: 27 tests; checks: 4 fail, 185 pass" in catalogue.ended.out
    assert catalogue.reports.json["status"] == "fail"


def test_honest_failures(catalogue):
    """Above 0.85 pu the paper's control flags no fault and goes on at full power: too much current, nothing else."""
    failed = {(test, c) for test, checks in catalogue.reports.verdicts.items() for c in checks if checks[c] == "fail"}
    assert failed == {(test, "current_limit") for test in HONEST_FAILURES}
    assert {v for checks in catalogue.reports.verdicts.values() for v in checks.values()} == {"pass", "fail"}


@pytest.mark.parametrize("drop", AT_FULL_POWER)
@pytest.mark.parametrize("run", [1, 2])
def test_drops_at_full_power(during, drop, run):
    """Powers and the largest phase current are those of the independent program."""
    p_kw, q_kvar, current_pu = AT_FULL_POWER[drop]
    measured = during[f"{drop}-full-{run}"]
    assert measured["active_power_kw"] == pytest.approx(p_kw, abs=10)
    assert measured["reactive_power_kvar"] == pytest.approx(q_kvar, abs=8)
    assert max(measured["current_phase_pu"]) == pytest.approx(current_pu, abs=0.02)


@pytest.mark.parametrize("drop", AT_FULL_POWER)
@pytest.mark.parametrize("run", [1, 2])
def test_drops_at_partial_power(during, drop, run):
    """Reactive power as at full power; active power at most what the array gives."""
    p_kw, q_kvar, _ = AT_FULL_POWER[drop]
    measured = during[f"{drop}-partial-{run}"]
    assert measured["reactive_power_kvar"] == pytest.approx(q_kvar, abs=8)
    assert measured["active_power_kw"] == pytest.approx(min(p_kw, 105), abs=10)


def test_second_run_starts_at_90_degrees(catalogue):
    """Run 1 starts at the maximum of phase a, run 2 a quarter of a period later."""
    angles = {t["id"]: t["scenario"]["point_on_wave_deg"] for t in catalogue.reports.json["tests"]}
    assert {angle for name, angle in angles.items() if name.endswith("-1")} == {0}
    assert {angle for name, angle in angles.items() if name.endswith("-2")} == {90}


def test_every_test_shows_its_verdict_everywhere(catalogue):
    """Terminal, JUnit, HTML and JSON carry the same verdict on every check."""
    verdicts = catalogue.reports.verdicts
    in_junit = {}
    for case in catalogue.reports.junit.iter("testcase"):
        name = case.get("classname").removeprefix("iec61400-21.")
        in_junit.setdefault(name, {})[case.get("name")] = "fail" if case.find("failure") is not None else "pass"
    assert in_junit == verdicts
    rows = catalogue.reports.page.xpath("//tr[@data-check]")
    in_html = [(row.get("data-check"), row.get("data-status")) for row in rows]
    assert in_html == [pair for checks in verdicts.values() for pair in checks.items()]
    lines = [line.split() for line in catalogue.ended.out.splitlines()]
    in_terminal = [
        (line[0], next(word for word in line if word in {"pass", "fail"}))
        for line in lines
        if len(line) > 5 and line[0] in verdicts["VD1-full-1"] and line[1] != "in"
    ]
    assert in_terminal == in_html


def test_junit_file_is_valid(catalogue, request):
    """A file of 27 suites validates against junit-10.xsd, and its totals agree."""
    schema = etree.XMLSchema(etree.parse(request.config.rootpath / "tests" / "schemas" / "junit-10.xsd"))
    schema.assertValid(etree.parse(catalogue.reports.folder / "junit.xml"))
    root = catalogue.reports.junit
    assert (root.get("tests"), root.get("failures"), root.get("errors")) == ("189", "4", "0")


def test_every_record_is_written(catalogue):
    """Each test has its COMTRADE pair."""
    names = {f"waveforms/{name}.{e}" for name in catalogue.reports.verdicts for e in ("cfg", "dat")}
    assert {name for name in catalogue.reports.files if name.startswith("waveforms/")} == names


def test_marks_of_the_procedures(catalogue):
    """The test table is from memory, and terminal and file say so."""
    marks = {test["id"]: test["confidence"] for test in catalogue.reports.json["tests"]}
    assert {mark for name, mark in marks.items() if name.startswith("VD")} == {"memory"}
    assert re.search(r"^Not verified: .*\b\d+ memory\b", catalogue.ended.out, re.MULTILINE)


def test_table_fits_80_columns(catalogue):
    """No line of the table is wrapped by a terminal of 80 columns."""
    table = catalogue.ended.out.partition("\n\n")[0]
    assert max(map(len, table.splitlines())) <= 80
    assert "…" not in table
