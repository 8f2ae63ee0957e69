import numpy as np
import pytest

from pvlvrt_compliance.simulation.translate import control_period_s
from validation.simulator import circuit, switched_circuit
from validation.simulator.ripple import FINE

pytestmark = pytest.mark.slow

needs_ngspice = pytest.mark.skipif(not circuit.installed(), reason="ngspice is missing (Debian package ngspice)")


@pytest.fixture(scope="module")
def ideal():
    """A run with ideal devices in both programs."""
    if not circuit.installed():
        pytest.skip("ngspice is missing (Debian package ngspice)")
    return switched_circuit.run()


def test_ngspice_gives_the_same_currents_and_voltage_with_switching_legs(ideal, assert_within):
    """In open loop through a sag currents agree within 0.5 % rms and the DC voltage within 0.1 %."""
    assert_within(circuit.rows({"switched": ideal.compared}))


def test_ngspice_gives_the_same_ripple(ideal, assert_within):
    """Between the samples currents agree within 0.05 % rms of nominal."""
    assert_within(switched_circuit.ripple_rows(ideal.ripple))


def test_a_carrier_that_is_late_shows_in_the_ripple(ideal):
    """A sixteenth of a period between the programs' pulses is not within the tolerance."""
    late = ideal.ripple._replace(theirs=np.roll(ideal.ripple.theirs, FINE // 16, axis=1))
    assert not all(row.within for row in switched_circuit.ripple_rows(late))


@needs_ngspice
def test_a_dead_time_shows():
    """A simulated dead time of 0.5 us, which the circuit does not have, is not within the tolerance."""
    found = switched_circuit.run(switched_circuit.ideal_devices(dead_time_us=0.5))
    assert found.compared.current_percent > circuit.CURRENT_LIMIT_PERCENT


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
