"""What each row of the shipped tables demands, against what the profile's own limits say of its voltage and frequency.

The limits are read here anew, from the numbers of the profile: nothing of how checks or profiles evaluate them is used.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.scenario.events import FurtherSag, PhaseJump
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import Entry, entries

PROFILES = (
    "dk-rfg",
    "dk-rfg-dk2",
    "dk-rfg-lt110kv",
    "es-nts-631-ge110kv",
    "es-nts-631-lt110kv",
    "es-po-12.3",
    "iec61400-21",
    "ieee1547-cat-ii",
    "ieee1547-cat-iii",
    "nerc-prc-029",
    "rey-boue-500kva",
    "spain-q-curve",
)

NTS_TABLE = "NTS 631 states the least duration of the category itself (Tables 48 to 50), beyond the straight line"
MODES_OF_1547_1 = "UL1741SB demands operation throughout conditions C and D, longer than the regions do"

WHOLE_ALL_THE_SAME = {
    ("es-nts-631-lt110kv", "U40TPmax"): NTS_TABLE,
    ("es-nts-631-lt110kv", "U40TPmed"): NTS_TABLE,
    **{("es-nts-631-lt110kv", f"U75TP{power}"): NTS_TABLE for power in ("max", "med", "medQmax", "medQmin", "min")},
    ("es-nts-631-ge110kv", "U40TPmax"): NTS_TABLE,
    ("es-nts-631-ge110kv", "U40TPmed"): NTS_TABLE,
    ("ieee1547-cat-iii", "low-voltage"): MODES_OF_1547_1,
    ("ieee1547-cat-iii", "low-voltage-one-phase"): MODES_OF_1547_1,
    ("ieee1547-cat-iii", "low-voltage-two-phases"): MODES_OF_1547_1,
}
"""Rows that go below the limits of their profile and are to be ridden through as a whole, with the reason."""

INSIDE = np.concatenate([[1e-6], np.linspace(0.01, 0.99, 99), [1 - 1e-6]])
NOTHING = 1e-7
TURN = np.exp(2j * np.pi / 3)


class Piece(NamedTuple):
    """What the source does from one change to the next; times in s from the start of the test."""

    begin_s: float
    end_s: float
    t_s: np.ndarray
    phases_pu: np.ndarray  # complex, (3, n)
    frequency_hz: np.ndarray

    def voltage_pu(self, quantity: str) -> np.ndarray:
        """The voltage that a limit speaks of."""
        a, b, c = self.phases_pu
        to_earth, between = np.abs([a, b, c]), np.abs([a - b, b - c, c - a]) / np.sqrt(3)
        return {
            "positive_sequence": np.abs(a + TURN * b + TURN**2 * c) / 3,
            "mean_phase": to_earth.mean(axis=0),
            "lowest_phase": to_earth.min(axis=0),
            "highest_phase": to_earth.max(axis=0),
            "lowest_line_to_line": between.min(axis=0),
            "highest_line_to_line": between.max(axis=0),
        }[quantity]


def pieces_of(scenario: Scenario) -> list[Piece]:
    """The whole record in pieces along which voltage and frequency run in straight lines."""
    table = [entry for entry in entries(scenario) if entry.t_s < scenario.end_s]
    ends_s = [*(entry.t_s for entry in table[1:]), scenario.end_s]
    return [piece_of(entry, end_s, scenario.start_s) for entry, end_s in zip(table, ends_s, strict=True)]


def piece_of(entry: Entry, end_s: float, start_s: float) -> Piece:
    """What an entry of the timeline does until the next."""
    since_s = INSIDE * (end_s - entry.t_s)
    positive, negative, zero = (
        u + slope * since_s for u, slope in zip(entry.sequences_pu, entry.slope_pu_s, strict=True)
    )
    phases_pu = np.array(
        [
            positive + negative + zero,
            positive / TURN + negative * TURN + zero,
            positive * TURN + negative / TURN + zero,
        ]
    )
    frequency_hz = entry.frequency_hz + entry.rocof_hz_s * since_s
    return Piece(entry.t_s - start_s, end_s - start_s, entry.t_s - start_s + since_s, phases_pu, frequency_hz)


def level_at(envelope, since_s: np.ndarray) -> np.ndarray:
    """Level of an envelope (pu) a time after it began to count (s)."""
    t, level = np.array(envelope.points).T
    if envelope.interpolation == "linear":
        return np.interp(since_s, t, level)
    return np.array([level[t <= s][-1] for s in since_s])


def leaves(envelope, pieces: list[Piece], sign: int) -> bool:
    """Whether the voltage goes beyond an envelope, which counts anew once it had come back to its last level."""
    counted_from_s, back = 0.0, True
    for piece in pieces:
        if piece.end_s <= 0:
            continue
        voltage_pu = piece.voltage_pu(envelope.voltage_quantity)
        counted_from_s = piece.begin_s if back else counted_from_s
        beyond = sign * (level_at(envelope, piece.t_s - counted_from_s) - voltage_pu) > NOTHING
        if beyond.any():
            return True
        back = bool(sign * (voltage_pu[-1] - envelope.points[-1][1]) >= -NOTHING)
    return False


def demanded_s(region, voltage_pu: float) -> float:
    """Time that a region demands at a voltage in it or beyond it (s)."""
    if region.mode not in {"mandatory", "permissive", "momentary_cessation"}:
        return 0.0
    if isinstance(region.ride_s, float):
        return region.ride_s
    inside_pu = min(max(voltage_pu, region.voltage_pu[0]), region.voltage_pu[1])
    return region.ride_s.s + region.ride_s.slope_s_per_pu * (inside_pu - region.ride_s.at_pu)


def outlasts(table, region, pieces: list[Piece]) -> bool:
    """Whether the voltage stays in a region, or beyond it, for longer than the region demands."""
    normal_low, normal_high = next(row.voltage_pu for row in table.rows if row.mode == "continuous")
    low = region.voltage_pu[1] <= normal_low
    spans: list[tuple[float, float]] = []
    for piece in pieces:
        voltage_pu = float(piece.voltage_pu(table.low_quantity if low else table.high_quantity)[0])
        here = voltage_pu < region.voltage_pu[1] - NOTHING if low else voltage_pu >= region.voltage_pu[0] - NOTHING
        if not low and region.voltage_pu[0] < normal_high:
            raise AssertionError("a region across normal operation")
        if here:
            spans.append((piece.begin_s, piece.end_s))
            if spent_s(spans, table.cumulative_window_s) > demanded_s(region, voltage_pu) + NOTHING:
                return True
        elif table.cumulative_window_s is None:
            spans = []
    return False


def spent_s(spans: list[tuple[float, float]], window_s: float | None) -> float:
    """Time inside until the end of the last span (s), within a sliding window where there is one."""
    first_s = -np.inf if window_s is None else spans[-1][1] - window_s
    return sum(end_s - max(begin_s, first_s) for begin_s, end_s in spans if end_s > first_s)


def leaves_frequencies(demand, pieces: list[Piece]) -> bool:
    """Whether a frequency lies outside of all bands, stays in one for longer than it demands, or changes too fast."""
    rows = demand.bands.rows
    t_s = np.concatenate([piece.t_s for piece in pieces])
    frequency_hz = np.concatenate([piece.frequency_hz for piece in pieces])
    if frequency_hz.min() < rows[0].frequency_hz[0] - 1e-6 or frequency_hz.max() > rows[-1].frequency_hz[1] + 1e-6:
        return True
    normal_low, normal_high = next(row.frequency_hz for row in rows if row.ride_s is None)
    for row in rows:
        if row.ride_s is not None:
            low = row.frequency_hz[1] <= normal_low
            edge_hz = row.frequency_hz[1] if low else row.frequency_hz[0]
            beyond = frequency_hz < edge_hz if low else frequency_hz > edge_hz
            assert low or edge_hz >= normal_high
            if np.diff(t_s)[beyond[:-1] & beyond[1:]].sum() > row.ride_s:
                return True
    if demand.rocof_hz_s is None:
        return False
    window_s = demand.rocof_window_s.value
    change_hz = np.interp(t_s + window_s, t_s, frequency_hz) - frequency_hz
    return bool(np.abs(change_hz).max() / window_s > demand.rocof_hz_s.value + 1e-3)


def jumps_deg(scenario: Scenario) -> Iterator[tuple[float, float]]:
    """Jumps of the positive-sequence angle and of the phase that jumps the furthest (deg)."""
    yield from ((event.angle_deg, 0.0) for event in scenario.events if isinstance(event, PhaseJump))
    sags = [scenario.sag, *(event.sag for event in scenario.events if isinstance(event, FurtherSag))]
    for sag in sags:
        if sag.angle_deg:
            turned = len(sag.phases) * (1 - sag.depth) * np.exp(1j * np.radians(sag.angle_deg))
            yield float(np.degrees(np.angle(turned + 3 - len(sag.phases)))), sag.angle_deg


def goes_beyond_limits(profile: Profile, scenario: Scenario) -> bool:
    """Whether a disturbance goes beyond what a profile demands to be ridden through, of any quantity."""
    pieces = pieces_of(scenario)
    found = []
    if demand := profile.ride_through:
        low = demand.envelope
        if scenario.sag.two_phase and demand.envelope_two_phase is not None:
            low = demand.envelope_two_phase
        found += [leaves(low, pieces, 1)] if low else []
        found += [leaves(demand.envelope_over_voltage, pieces, -1)] if demand.envelope_over_voltage else []
        if (table := demand.regions) is not None:
            found += [outlasts(table, row, pieces) for row in table.rows if row.mode != "continuous"]
    if frequencies := profile.requirements.of_kind("frequency_ride_through"):
        found.append(leaves_frequencies(frequencies, pieces))
    if angles := profile.requirements.of_kind("phase_jump_ride_through"):
        largest, single = angles.all_phases_deg.value, angles.single_phase_deg
        for positive_deg, phase_deg in jumps_deg(scenario):
            found.append(abs(positive_deg) > largest or (single is not None and abs(phase_deg) > single.value))
    return any(found)


@pytest.mark.parametrize("name", PROFILES)
def test_rows_demand_what_the_limits_say(shipped, name):
    """A row may trip exactly where its disturbance goes beyond the profile's limits, but for those named above."""
    profile = shipped[name]
    cases = {case.row: case for case in profile.tests()}
    found = {}
    for case in cases.values():
        row = next(row for row in profile.all_rows if case.row in {row.id, *(f"{row.id}-{p}" for p in row.powers)})
        found[row.id] = (row.expect, "may_trip" if goes_beyond_limits(profile, case.scenario) else "ride_through")
    assert len(found) == len(profile.all_rows)
    exceptions = {row_id for known, row_id in WHOLE_ALL_THE_SAME if known == name}
    assert {row_id for row_id, (stated, computed) in found.items() if stated != computed} == exceptions
    assert all(found[row_id] == ("ride_through", "may_trip") for row_id in exceptions)


def test_every_shipped_profile_is_looked_at(shipped):
    """No profile that ships is left out of the comparison."""
    assert set(PROFILES) == set(shipped)


def test_tests_made_from_corners_are_ridden_through(shipped):
    """What is made from the corners of regions lies inside of them, and is demanded as a whole."""
    made = [row for profile in shipped.values() for row in profile.all_rows if row not in profile.rows]
    assert made
    assert {row.expect for row in made} == {"ride_through"}


def test_every_run_of_a_row_has_its_demand(shipped):
    """A run carries what its row demands; a sag of the user's own has no row."""
    profile = shipped["dk-rfg"]
    demands = {case.id: case.expect for case in profile.tests()}
    assert demands["3ph-0.20-60s"] == "may_trip"
    assert demands["3ph-0.20-full"] == demands["3ph-0.20-partial"] == "ride_through"
    assert profile.ad_hoc_test(profile.rows[0].sag).expect is None


def test_pieces_follow_the_voltage_asked_for(shipped):
    """The voltages that rows are judged by are those of phasors: one phase to 0.2 pu leaves 0.643 pu between phases."""
    (case,) = (case for case in shipped["dk-rfg"].tests() if case.id == "1ph-0.20-full")
    sag = next(piece for piece in pieces_of(case.scenario) if piece.begin_s == 0)
    assert sag.voltage_pu("lowest_phase")[0] == pytest.approx(0.2)
    assert sag.voltage_pu("lowest_line_to_line")[0] == pytest.approx(np.sqrt(1 + 0.2 + 0.04) / np.sqrt(3))
    assert sag.voltage_pu("positive_sequence")[0] == pytest.approx(2.2 / 3)
    assert all(first.end_s == then.begin_s for first, then in pairwise(pieces_of(case.scenario)))
