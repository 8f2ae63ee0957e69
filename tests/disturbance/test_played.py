"""What the grid did in a test that plays a recording back: what is found there, and what else was asked for."""

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.found import Thresholds
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.disturbance.played import disturbance_played
from pvlvrt_compliance.scenario.events import GridStrength, Irradiance, Recording
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Segment, Waveforms

NOMINAL = Nominal()
THRESHOLDS = Thresholds(NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.02))
PLAYED = Recording(file="fault.csv", t_s=0.0)


def scenario_of(*events, **fields):
    """A test of 1 s from 0.3 s on, that asks for no sag unless it is said."""
    return Scenario(**({"sag": Sag(depth=0.0), "duration_s": 1.0} | fields), events=events)


def record(left, jump_deg=0.0):
    """Voltages of the source: a jump of the angle at 0.3 s, and what is left from 0.6 s to 0.9 s."""
    t = np.arange(0, 2.4, 1e-4)
    amplitude = NOMINAL.phase_voltage_peak_v * np.where((t >= 0.6) & (t < 0.9), left, 1.0)
    angle = 2 * np.pi * 50 * t + np.radians(jump_deg) * (t >= 0.3)
    channels = {f"u0_{phase}_v": amplitude * np.cos(angle - 2 * np.pi * k / 3) for k, phase in enumerate("abc")}
    return Waveforms((Segment(0.0, 1e-4, channels),))


@pytest.mark.parametrize(("left", "kind"), [(0.5, "sag"), (0.0, "sag"), (1.2, "swell")])
@pytest.mark.parametrize("jump_deg", [0.0, 40.0])
def test_times_count_from_the_first_sag(left, kind, jump_deg):
    """Or swell; a jump of the angle before it is told, and is no beginning."""
    found = disturbance_played(scenario_of(PLAYED), record(left, jump_deg), NOMINAL, THRESHOLDS)
    assert (found.start_s, found.clear_s) == (pytest.approx(0.6, abs=1e-4), pytest.approx(0.9, abs=1e-4))
    during = found.stretch_at(0.75)
    assert (during.kind, during.voltage.positive_pu) == (kind, pytest.approx(left, abs=1e-6))
    assert not found.frequency_moves  # nor is any known where there is no voltage
    assert [round(jump.positive_deg, 3) for jump in found.jumps] == ([40.0] if jump_deg else [])
    assert "recording fault.csv" in found.in_words


def test_without_a_sag_times_count_from_what_there_is():
    """A jump of the angle alone."""
    found = disturbance_played(scenario_of(PLAYED), record(1.0, 40.0), NOMINAL, THRESHOLDS)
    assert found.start_s == pytest.approx(0.3, abs=1e-4)


def test_what_is_not_in_the_voltage_is_as_it_was_asked_for():
    """Irradiance and the strength of the grid are of the scenario."""
    scenario = scenario_of(PLAYED, Irradiance(t_s=0.2, to_w_m2=400.0), GridStrength(t_s=0.8, scr=5.0))
    found = disturbance_played(scenario, record(0.5), NOMINAL, THRESHOLDS)
    asked = disturbance_asked(scenario, THRESHOLDS.normal)
    assert found.irradiance_w_m2 == asked.irradiance_w_m2 == (1000.0, 400.0)
    assert found.record_end_s == scenario.end_s
    assert found.steps_of("irradiance") == asked.steps_of("irradiance")
    assert found.steps_of("strength") == asked.steps_of("strength") == (1.1,)
    assert found.steps_of("recording") == (0.3,)
    assert found.stretches[0].irradiance_w_m2 == 1000.0


@pytest.mark.parametrize(
    "scenario",
    [
        scenario_of(),
        scenario_of(PLAYED, sag=Sag(depth=0.5)),
        scenario_of(PLAYED, sag=Sag(depth=0.0, angle_deg=20.0)),
    ],
)
def test_what_is_asked_for_is_judged_by_that(scenario):
    """A test without a recording, and one that asks for a sag or a turn itself."""
    assert disturbance_played(scenario, record(0.5), NOMINAL, THRESHOLDS) is None


def test_nothing_found_is_nothing_said():
    """Whoever asked for nothing gets what the scenario says."""
    assert disturbance_played(scenario_of(PLAYED), record(1.0), NOMINAL, THRESHOLDS) is None
