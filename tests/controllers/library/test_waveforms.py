"""The bundled controller rebuilt in C gives the waveforms of the one that is compiled by numba."""

import numpy as np
import pytest

from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.plant import pv_array
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.translate import nominal_of, pv_params

pytestmark = pytest.mark.compiler

TOLERANCE = 1e-9
"""Largest difference of a channel, of its largest value."""

FROM_THE_SAME_START = ("simulation.settling_s=0.5", "simulation.synchronising_s=0")

SCENARIOS = {
    "three phases": Scenario(sag=Sag(depth=0.9), duration_s=0.309),
    "one phase": Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=0.6),
    "two phases, searching the maximum power": Scenario(
        sag=Sag(depth=0.8, phases="bc", two_phase=True), duration_s=0.5, irradiance_w_m2=200.0
    ),
    "60 Hz, reactive power": Scenario(
        sag=Sag(depth=0.5), duration_s=0.3, frequency_hz=60.0, reactive_power_pu=0.2, irradiance_w_m2=500.0
    ),
}


@pytest.mark.parametrize("scenario", SCENARIOS.values(), ids=SCENARIOS)
def test_same_waveforms(bundled_in_c, scenario):
    """Every channel that both have differs by no more than rounding."""
    parameters = parameters_from(FROM_THE_SAME_START)
    start_v = pv_array.maximum_power_point(scenario.irradiance_w_m2, pv_params(parameters, scenario)).v
    (mine,) = ForeignSimulator(str(bundled_in_c), {"mppt_start_v": start_v})(scenario, parameters)
    (theirs,) = simulate(scenario, parameters)
    both = set(mine.channels) & set(theirs.channels)
    assert both >= {"i_a_a", "v_dc_v", "m_alpha", "m_beta", "v_fault_pu", "q_ref_var", "p_ref_w"}
    apart = {c: np.abs(mine[c] - theirs[c]).max() / max(np.abs(theirs[c]).max(), 1.0) for c in both}
    assert {channel: x for channel, x in apart.items() if not x <= TOLERANCE} == {}


def test_started_by_the_host_it_settles_in_the_same_state(bundled_in_c):
    """Held in the steady state first and then let go, as it is by default, it is measured the same."""
    scenario, parameters = SCENARIOS["one phase"], Parameters()
    mine, theirs = (
        measure(run(scenario, parameters), nominal_of(parameters, scenario), scenario.start_s, scenario.clear_s)
        for run in (ForeignSimulator(str(bundled_in_c)), simulate)
    )
    assert mine.during.active_power_kw == pytest.approx(theirs.during.active_power_kw, rel=1e-3)
    assert mine.during.reactive_power_kvar == pytest.approx(theirs.during.reactive_power_kvar, rel=1e-3)
    assert mine.after.active_power_kw == pytest.approx(theirs.after.active_power_kw, rel=1e-3)
