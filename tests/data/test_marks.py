"""Marks: of numbers, of tables, and of single rows and points in them."""

from typing import Any

import pytest
from pydantic import ValidationError

from pvlvrt_compliance.checks.verdicts import judged
from pvlvrt_compliance.data.marks import Mark, MarkedRow, marks_in, weakest
from pvlvrt_compliance.profile.curves import Envelope
from pvlvrt_compliance.profile.regions import RegionTable
from pvlvrt_compliance.profile.requirements import FrequencyRideThrough
from pvlvrt_compliance.profile.tables import FrequencyBands, HarmonicLimits, RecoveryTable
from pvlvrt_compliance.results import Status

TABLE = {"confidence": "code", "source": "a table"}
OWN = {"confidence": "memory", "source": "a row"}

ROWS: dict[Any, list[dict[str, Any]]] = {
    FrequencyBands: [{"frequency_hz": (47.5, 49.0), "ride_s": 9.0}, {"frequency_hz": (49.0, 51.0)}],
    RecoveryTable: [
        {"residual_pu": (0.0, 0.5), "first_s": 1.0, "final_extra_s": 1.0},
        {"residual_pu": (0.5, 0.9), "first_s": 1.0, "final_extra_s": 1.0},
    ],
    HarmonicLimits: [{"orders": (2, 3), "limit_percent": 1.0}, {"orders": (4, 9), "limit_percent": 2.0}],
    RegionTable: [
        {"voltage_pu": (0.0, 0.9), "mode": "mandatory", "ride_s": 1.0},
        {"voltage_pu": (0.9, 1.1), "mode": "continuous"},
    ],
}
QUANTITIES = {"low_quantity": "lowest_phase", "high_quantity": "highest_phase"}


def table_of(kind, second=None):
    """Table of a kind with two rows; ``second`` are further keys of the second one."""
    first, last = ROWS[kind]
    more = QUANTITIES if kind is RegionTable else {}
    return kind.model_validate(TABLE | more | {"rows": (first, last | (second or {}))})


def envelope(*points):
    """A line through points, under the mark of a table."""
    return Envelope.model_validate(
        TABLE | {"points": points, "interpolation": "linear", "voltage_quantity": "lowest_phase"}
    )


@pytest.mark.parametrize("kind", ROWS)
def test_a_mark_of_a_row_wins_over_that_of_its_table(kind):
    """The row that has one is as sure as it says; the others are as sure as the table, and the whole as the weakest."""
    table = table_of(kind, OWN)
    first, last = map(table.mark_of, table.rows)
    assert (first.confidence, first.source) == ("code", "a table")
    assert (last.confidence, last.source) == ("memory", "a row")
    assert weakest(table.marks) == "memory"
    assert [(name, mark.confidence) for name, mark in marks_in(table, "t")] == [("t", "code"), ("t.rows[1]", "memory")]


@pytest.mark.parametrize("kind", ROWS)
def test_rows_without_a_mark_have_that_of_their_table(kind):
    """A table without such rows is one item, as before."""
    table = table_of(kind)
    assert {table.mark_of(row).confidence for row in table.rows} == set(table.marks) == {"code"}
    assert [name for name, _ in marks_in(table, "t")] == ["t"]


@pytest.mark.parametrize(("given", "missing"), [("confidence", "source"), ("source", "confidence")])
def test_half_a_mark_is_none(given, missing):
    """A row says how sure it is and where it comes from, or neither."""
    with pytest.raises(ValidationError, match=f"{missing}: missing; a row with {given} of its own has both"):
        MarkedRow.model_validate({given: OWN[given]})


def test_a_point_may_be_a_table_with_a_mark():
    """Points with and without a mark are one line; what lies between two of them is as sure as the weaker."""
    line = envelope((0, 0.0), (0.5, 0.0), {"t_s": 1.5, "u_pu": 0.8, **OWN})
    assert line.points == ((0, 0.0), (0.5, 0.0), (1.5, 0.8))
    assert float(line.voltage_at(1.0)) == pytest.approx(0.4)
    assert line.time_of(0.4) == pytest.approx(1.0)
    assert [line.mark_at(t_s).confidence for t_s in (0.0, 0.3, 0.5, 1.0, 1.5, 9.0)] == [
        *("code", "code", "code"),
        *("memory", "memory", "memory"),
    ]
    assert [name for name, _ in marks_in(line, "e")] == ["e", "e.points[2]"]
    assert Envelope.model_validate_json(line.model_dump_json(by_alias=True)) == line


def test_a_line_of_plain_points_is_written_as_before():
    """Points without a mark stay lists."""
    assert envelope((0, 0.0), (1, 0.8)).model_dump(by_alias=True)["points"] == ((0.0, 0.0), (1.0, 0.8))


def test_a_verdict_is_as_sure_as_the_row_that_it_rests_on():
    """Of a table as a whole every row counts; of one row, its own mark."""
    table = table_of(FrequencyBands, OWN)
    demand = FrequencyRideThrough(clause="c", source="s", bands=table)
    numbers = {"measured": 1, "limit": 1, "margin": 0, "unit": "s", "at_s": 0}

    def confidence(mark):
        return judged("k", demand, Status.PASS, "m", **numbers, rests_on=[mark]).confidence

    assert confidence(table) == demand.confidence == "memory"
    assert [confidence(table.mark_of(row)) for row in table.rows] == ["code", "memory"]
    assert confidence(Mark(**TABLE)) == "code"


def test_a_number_of_a_table_is_no_mark_of_its_rows():
    """The least current of a table of regions is told, and weakens nothing that rests on the times of the regions."""
    least = {"value": 0.5, "confidence": "chosen", "source": "a number"}
    table = RegionTable.model_validate(
        TABLE
        | QUANTITIES
        | {"rows": ROWS[RegionTable], "least_current_fraction": least, "least_current_of": "largest_phase"}
    )
    assert weakest(table.marks) == "code"
    assert [name for name, _ in marks_in(table, "t")] == ["t", "t.least_current_fraction"]
