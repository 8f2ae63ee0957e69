"""The voltages imposed in a test against those asked for."""

import pytest

from pvlvrt_compliance.disturbance.model import Stretch, Voltage
from pvlvrt_compliance.measure.quantities import MeasuredStretch, MeasuredWindows, WindowMeasurements
from pvlvrt_compliance.report.document.scenario import imposed_rows
from pvlvrt_compliance.report.language import Texts
from told_scenarios import result


def window(begin_s, end_s, positive_pu, negative_pu=0.0):
    """A window with its voltages."""
    return WindowMeasurements(
        start_s=begin_s, end_s=end_s, voltage_positive_pu=positive_pu, voltage_negative_pu=negative_pu
    )


def test_the_sag_imposed_stands_against_the_one_asked_for():
    """One phase to 0.10 pu leaves V+ = 0.70 and V- = 0.30 by Fortescue; what was measured stands beside it."""
    measured = MeasuredWindows(before=window(0.1, 0.2, 1.0), during=window(0.4, 0.7, 0.7123, 0.2904))
    before, during = imposed_rows(
        result({"sag": {"depth": 0.9, "phases": "c"}}, measurements=measured, expect="ride_through"), Texts()
    )
    assert (before.asked_positive, before.measured_positive, before.difference_positive) == (
        "1.000 pu",
        "1.000 pu",
        "+0.000 pu",
    )
    assert during[1:] == (
        "0.400 s to 0.700 s",
        "0.700 pu",
        "0.712 pu",
        "+0.012 pu",
        "0.300 pu",
        "0.290 pu",
        "-0.010 pu",
    )


def test_each_stretch_has_a_row():
    """Where the voltage has several steps each stretch is told; along a ramp what is asked is the mean."""
    points = [[0, 1.0], [0, 0.0], [0.2, 0.0], [1.0, 0.8], [1.0, 1.0]]
    parts = [(0.35, 0.45, 0.0), (0.6, 1.2, 0.4), (1.4, 1.8, 1.0)]
    stretches = tuple(MeasuredStretch(begin_s=a, end_s=b, window=window(a, b, u)) for a, b, u in parts)
    short = MeasuredStretch(begin_s=0, end_s=0.01, window=None)
    measured = MeasuredWindows(stretches=(*stretches, short))
    scenario = {"duration_s": 1.0, "events": [{"kind": "voltage_profile", "points": points}]}
    found = imposed_rows(result(scenario, measurements=measured), Texts())
    assert [(row.name, row.asked_positive, row.difference_positive) for row in found] == [
        ("stretch 1", "0.000 pu", "+0.000 pu"),
        ("stretch 2", "0.400 pu", "+0.000 pu"),
        ("stretch 3", "1.000 pu", "+0.000 pu"),
    ]


@pytest.mark.parametrize(
    "event",
    [
        {"kind": "frequency_ramp", "t_s": 0.1, "rate_hz_s": 1, "duration_s": 1},
        {"kind": "phase_jump", "t_s": 0.2, "angle_deg": 20},
    ],
)
def test_no_mean_voltage_over_a_moving_angle(event):
    """Phasors that turn cancel out: their mean is no voltage, and none is shown."""
    measured = MeasuredWindows(during=window(0.4, 0.7, 0.109))
    (row,) = imposed_rows(result({"events": [event]}, measurements=measured), Texts())
    assert (row.asked_positive, row.measured_positive, row.difference_positive) == ("1.000 pu", "", "")


def test_a_difference_is_that_of_the_numbers_shown():
    """0.1004 and 0.0996 read 0.100 both: their difference reads 0.000."""
    stretch = Stretch(begin_s=0, end_s=2, kind="sag", voltage=Voltage(positive_pu=0.0996, negative_pu=0, zero_pu=0))
    grid = result().disturbance.model_copy(update={"stretches": (stretch,)})
    measured = MeasuredWindows(during=window(0.4, 0.7, 0.1004))
    (row,) = imposed_rows(result(disturbance=grid, measurements=measured), Texts())
    assert (row.asked_positive, row.measured_positive, row.difference_positive) == ("0.100 pu", "0.100 pu", "+0.000 pu")
