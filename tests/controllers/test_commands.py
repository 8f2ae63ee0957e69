"""One controller that commands the same voltage in every way there is."""

import numpy as np
import pytest

from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from

pytestmark = pytest.mark.compiler

SCENARIO = Scenario(sag=Sag(depth=0.0), before_s=0.25, duration_s=0.02, after_s=0.1)
QUICK = ("simulation.settling_s=0.2", "simulation.synchronising_s=0.01")


@pytest.fixture(scope="module")
def record(compiled):
    """Record of the controller, built with a definition or without."""

    def make(*definitions, settings=(), **given):
        parameters = parameters_from((*QUICK, *settings))
        (segment,) = ForeignSimulator(str(compiled("commanding.c", *definitions)), given)(SCENARIO, parameters).segments
        return segment

    return make


@pytest.mark.parametrize("definition", ["DUTY", "FRAME"])
def test_duties_and_voltages_in_a_frame_are_the_same_command(record, definition):
    """The waveforms are those of modulating signals, to rounding: of legs' shares, and of u_d, u_q and an angle."""
    expected, found = record(), record(definition)
    assert np.abs(expected["i_a_a"][-1000:]).max() > 500
    for name in ("i_a_a", "i_b_a", "i_c_a", "v_dc_v", "m_alpha", "m_beta"):
        assert np.abs(found[name] - expected[name]).max() < 1e-6 * max(np.abs(expected[name]).max(), 1)


def test_an_enable_that_is_taken_back_blocks(record):
    """An output ``pwm_enable`` of 0 blocks the bridge: no current from there on, and the breaker stays closed."""
    off = 0.21 + 0.3  # its clock began 0.21 s before the record does
    segment = record(enable_until=off)
    current = np.abs([segment[f"i_{x}_a"] for x in "abc"]).max(axis=0)
    assert current[(segment.t_s > 0.29) & (segment.t_s < 0.2998)].max() > 1
    assert current[segment.t_s > 0.302].max() == 0
    assert segment["connected"].min() == 1


@pytest.mark.parametrize(("hold", "times", "begins"), [("each", 100, True), ("once", 1, True), ("run", 1, False)])
def test_how_often_a_controller_is_told_that_it_does_not_act_yet(record, hold, times, begins):
    """Initialize is called in all 100 samples before the first that acts, or once; free, on outputs of its own."""
    segment = record(settings=(f"controller.hold={hold}",))
    assert set(segment["initialised"]) == {times}
    assert bool(segment["began_at"][0] > 0.5) is begins
