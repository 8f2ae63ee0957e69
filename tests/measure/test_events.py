import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.events import EventThresholds, VoltageEvent, detect_events

SAGS = EventThresholds(enter_below=0.85, leave_above=0.87)


def found(voltages, thresholds=SAGS, high=None):
    """Events of voltages given second by second."""
    u = np.array(voltages, dtype=float)
    return detect_events(np.arange(float(len(u))), u, u if high is None else np.array(high, dtype=float), thresholds)


def test_a_sag_with_hysteresis():
    """It starts under one threshold and ends over the other; in between nothing happens either way."""
    assert found([1, 0.86, 0.8, 0.5, 0.86, 0.84, 0.9, 0.86, 1]) == (VoltageEvent(2.0, 6.0, "sag"),)


def test_both_thresholds_are_exclusive():
    """A voltage at a threshold is neither below nor above it."""
    one = EventThresholds(enter_below=0.85)
    assert found([1, 0.85, 1], one) == ()
    assert found([1, 0.84, 0.85, 0.86], one) == (VoltageEvent(1.0, 3.0, "sag"),)


def test_a_swell_and_a_sag_at_once():
    """One phase low and another high are two events, in order of their start."""
    thresholds = EventThresholds(enter_below=0.9, leave_above=0.92, enter_above=1.1, leave_below=1.08)
    events = found([1, 1, 0.5, 0.5, 1, 1], thresholds, high=[1, 1.2, 1.3, 1.09, 1.0, 1])
    assert events == (VoltageEvent(1.0, 4.0, "swell"), VoltageEvent(2.0, 4.0, "sag"))


def test_an_interruption_is_a_sag_of_all_phases():
    """With the highest phase too under its threshold the event is an interruption; with the lowest alone a sag."""
    thresholds = EventThresholds(enter_below=0.9, interruption_below=0.05)
    low = [1, 0.5, 0.02, 0.03, 1]
    assert found(low, thresholds)[0] == VoltageEvent(1.0, 4.0, "interruption")
    assert found(low, thresholds, high=[1, 1, 0.9, 0.9, 1])[0].kind == "sag"


def test_an_event_that_the_record_cuts_off():
    """Without a return there is no end; a record may start in a sag."""
    assert found([0.2, 0.3, 1, 0.4]) == (VoltageEvent(0.0, 2.0, "sag"), VoltageEvent(3.0, None, "sag"))


def test_gaps_start_and_end_nothing():
    """The first cycle of a record, and a gap in a sag, leave events as they are."""
    nan = np.nan
    assert found([nan, nan, 1, 1]) == ()
    assert found([nan, 0.5, nan, 0.6, 1, nan]) == (VoltageEvent(1.0, 4.0, "sag"),)
    assert found([nan, nan]) == found([]) == ()


def test_what_has_no_threshold_is_not_looked_for():
    """No thresholds, no events."""
    assert found([1, 0, 2, 1], EventThresholds()) == ()
    assert [e.kind for e in found([1, 0, 2, 1], EventThresholds(enter_above=1.1))] == ["swell"]


@pytest.mark.parametrize(
    "thresholds",
    [EventThresholds(enter_below=0.85, leave_above=0.8), EventThresholds(enter_above=1.1, leave_below=1.2)],
)
def test_hysteresis_the_wrong_way_round(thresholds):
    """A threshold to leave on the wrong side would let events end where they begin."""
    with pytest.raises(MeasurementError, match="cannot end"):
        found([1, 0.5, 1], thresholds)


@given(st.lists(st.floats(0, 1.5), max_size=60))
def test_events_are_those_of_a_walk_through_the_samples(voltages):
    """A plain loop with one flag finds the same sags."""
    expected, start = [], None
    for k, u in enumerate(voltages):
        if start is None and u < 0.85:
            start = k
        elif start is not None and u > 0.87:
            expected.append(VoltageEvent(start, k, "sag"))
            start = None
    if start is not None:
        expected.append(VoltageEvent(start, None, "sag"))
    assert list(found(voltages)) == expected
