import numpy as np
import pytest

import circuit
import switched_circuit
from pvlvrt_compliance.simulation.translate import control_period_s

needs_ngspice = pytest.mark.skipif(not circuit.installed(), reason="ngspice is missing (Debian package ngspice)")


@needs_ngspice
def test_ngspice_gives_the_same_currents_and_voltage_with_switching_legs(assert_within):
    """In open loop through a sag currents agree within 0.5 % rms and the DC voltage within 0.1 %."""
    assert_within(switched_circuit.section().rows)


@needs_ngspice
def test_a_dead_time_shows():
    """A simulated dead time of 0.5 us, which the circuit does not have, is not within the tolerance."""
    compared = switched_circuit.compare(switched_circuit.ideal_devices(dead_time_us=0.5))
    assert compared.current_percent > circuit.CURRENT_LIMIT_PERCENT


def test_the_sag_begins_and_ends_within_a_control_period():
    """The events that are compared lie between samples of the controller."""
    scenario = circuit.scenario_of(switched_circuit.SAG, switched_circuit.SAG_STEPS)
    dt = control_period_s(switched_circuit.ideal_devices())
    for instant in (scenario.start_s, scenario.clear_s):
        assert 0.1 < (instant / dt) % 1 < 0.9


def test_overmodulation_is_not_drawn_as_gates():
    """A signal beyond the linear range has no pulse in every period, and is refused."""
    with pytest.raises(ValueError, match="overmodulation"):
        switched_circuit.gate_edges(np.array([[1.0], [-0.5], [-0.5]]) * 1.5, np.array([0.0, 1.0]))
