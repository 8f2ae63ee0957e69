"""What a check sees of one record: its stretches, what is settled in them, and what opened the breaker."""

import dataclasses

import numpy as np
import pytest

from made_evidence import DT_S, INNER, evidence_of
from pvlvrt_compliance.evidence.evidence import NotApplicable, floors_of
from pvlvrt_compliance.evidence.stretches import after_each_step, between_steps_s, settled_pu, settling_s
from pvlvrt_compliance.evidence.voltages import voltage_quantity_pu
from pvlvrt_compliance.measure.summary import STANDARD_FLOORS
from pvlvrt_compliance.profile.thresholds import STANDARD_THRESHOLDS
from pvlvrt_compliance.waveforms.container import Waveforms


def test_stretches_follow_the_steps_of_the_voltage():
    """From each step to the next, the last to the end of the record; each measured where it is settled."""
    evidence = evidence_of()
    assert [part.begin_s for part in evidence.voltage_stretches] == pytest.approx([0.3, 0.5, 0.65, 0.9])
    assert evidence.voltage_stretches[-1].end_s == evidence.waveforms.end_s
    windows = [part.window for part in evidence.measured_stretches]
    assert [window.voltage_positive_pu for window in windows] == pytest.approx([0.7, 0.2, 0.7, 1.0], abs=1e-9)
    for part, window in zip(evidence.voltage_stretches, windows, strict=True):
        assert part.begin_s < window.start_s < window.end_s <= part.end_s + DT_S


def test_a_stretch_too_short_for_a_cycle_has_no_window():
    """15 ms hold no settled cycle: the stretch is there, without numbers."""
    short = INNER | {"duration_s": 0.015}
    evidence = evidence_of(events=(short,), levels=((0.0, 1.0), (0.3, 0.7), (0.5, 0.2), (0.515, 0.7), (0.9, 1.0)))
    assert [part.window is None for part in evidence.measured_stretches] == [False, True, False, False]


@pytest.mark.parametrize(
    ("at_s", "between", "level"), [(0.1, (0.0, 0.3), 1.0), (0.55, (0.5, 0.65), 0.2), (1.5, (0.9, None), 1.0)]
)
def test_what_is_settled_next_to_an_instant(at_s, between, level):
    """The median between two steps has nothing of the cycle in which the voltage was on its way."""
    evidence = evidence_of()
    begin_s, end_s = between_steps_s(evidence, at_s)
    assert (begin_s, end_s) == pytest.approx(
        (between[0], evidence.waveforms.end_s if between[1] is None else between[1])
    )
    assert settled_pu(evidence, evidence.voltage_positive_pu, at_s) == pytest.approx(level, abs=1e-9)


def test_a_step_spoils_one_cycle_and_a_tenth():
    """Outside of that the one-cycle voltage is where it leads to, inside it is not."""
    evidence = evidence_of()
    spoiled = after_each_step(evidence, settling_s(evidence), evidence.disturbance.voltage_steps_s)
    known = ~spoiled & (evidence.t_s > 0.021)
    asked = np.array([evidence.disturbance.no_load(t).positive_pu for t in evidence.t_s[known]])
    assert evidence.voltage_positive_pu[known] == pytest.approx(asked, abs=1e-9)
    assert np.abs(evidence.voltage_positive_pu[spoiled] - 0.7).max() > 0.2


def test_every_voltage_that_codes_speak_of_is_the_same_in_a_balanced_grid():
    """Sequences, phases and line-to-line voltages of a balanced grid are all one number."""
    evidence = evidence_of()
    settled = evidence.between(0.4, 0.499)
    for quantity in ("positive_sequence", "mean_phase", "lowest_phase", "highest_phase", "lowest_line_to_line"):
        assert voltage_quantity_pu(evidence, quantity)[settled] == pytest.approx(0.7, abs=1e-9)


@pytest.mark.parametrize(("code", "words"), [(0, None), (1, "over-current relay of the plant"), (99, "cause 99")])
def test_the_cause_of_a_trip_is_a_fact_of_the_record(code, words):
    """A record that says why the breaker opened is believed; one without the channel says nothing."""
    assert evidence_of(trip_cause=lambda t: np.where(t > 0.4, code, 0)).trip_cause == words
    assert evidence_of().trip_cause is None


def test_a_sag_too_short_has_no_window():
    """Whoever needs the window during the sag is let off with the reason."""
    evidence = evidence_of(duration_s=0.05, events=(), levels=((0.0, 1.0), (0.3, 0.7), (0.35, 1.0)))
    with pytest.raises(NotApplicable, match=r"0\.050 s leaves no whole cycle"):
        evidence.during()


def test_windows_are_measured_by_the_floors_of_the_profile():
    """Without a profile they are the usual ones; a higher floor leaves a window without a frequency."""
    assert floors_of(STANDARD_THRESHOLDS) == STANDARD_FLOORS
    usual = evidence_of().measured_stretches[0].window
    floor = STANDARD_THRESHOLDS.window_voltage_floor_pu.model_copy(update={"value": 0.8})
    thresholds = STANDARD_THRESHOLDS.model_copy(update={"window_voltage_floor_pu": floor})
    faint = dataclasses.replace(evidence_of(), thresholds=thresholds).measured_stretches[0].window
    assert usual.voltage_positive_pu == faint.voltage_positive_pu == pytest.approx(0.7, abs=1e-6)
    assert (usual.frequency_hz, faint.frequency_hz) == (pytest.approx(50, abs=1e-3), None)


def test_what_is_made_of_a_record_is_made_once():
    """By its key, whatever would be made the next time; another key and another record have their own."""
    evidence, other = evidence_of(), evidence_of()
    assert [evidence.once("a", lambda: 1), evidence.once("a", lambda: 2), evidence.once(("a", 0.3), lambda: 3)] == [
        1,
        1,
        3,
    ]
    assert other.once("a", lambda: 4) == 4


@pytest.mark.parametrize(("start_s", "end_s"), [(0.3, 0.5), (0.31234, 0.31234), (-1.0, 9.0), (5.0, 6.0), (0.5, 0.3)])
def test_samples_are_those_that_a_mask_of_the_same_instants_has(start_s, end_s):
    """Both ends included, though an instant is a rounding off the grid; or without the one at the end."""
    evidence = evidence_of()
    t_s, every = evidence.t_s, np.arange(len(evidence.t_s))
    inside = (t_s >= start_s - 1e-9) & (t_s <= end_s + 1e-9)
    assert every[evidence.samples(start_s, end_s)].tolist() == every[inside].tolist()
    before = (t_s >= start_s - 1e-9) & (t_s < end_s)
    assert every[evidence.samples_before(start_s, end_s)].tolist() == every[before].tolist()


def test_what_is_made_for_an_object_is_not_for_one_that_equals_it():
    """Not even once the first is gone and another may stand where it stood."""
    evidence = evidence_of()
    made = [evidence.once_for([0], "length", lambda k=k: k) for k in range(20)]
    assert made == list(range(20))
    item = [0]
    assert [evidence.once_for(item, "length", lambda k=k: k) for k in (7, 8)] == [7, 7]


def test_the_largest_current_is_that_of_the_phase_that_carries_most():
    """Of the one-cycle amplitudes and of the instantaneous values; here of phase b."""
    evidence = evidence_of()
    (segment,) = evidence.waveforms.segments
    unit_a = evidence.nominal.phase_current_peak_a / evidence.nominal.phase_voltage_peak_v
    currents = {
        f"i_{phase}_a": size * unit_a * segment[f"u_{phase}_v"]
        for phase, size in zip("abc", (0.5, 0.8, 0.3), strict=True)
    }
    carrying = dataclasses.replace(segment, channels={**segment.channels, **currents})
    evidence = dataclasses.replace(evidence, waveforms=Waveforms((carrying,)))
    steady = evidence.samples(0.1, 0.2)
    assert evidence.largest_current_pu[steady] == pytest.approx(evidence.current_phase_pu[1][steady])
    assert evidence.largest_instantaneous_pu == pytest.approx(np.abs(evidence.current_pu).max(axis=0))
