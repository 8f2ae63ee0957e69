import pytest

from validation.simulator import blocks, frequency_lock, loops


def test_cells_have_their_transfer_functions(assert_within):
    """The quadrature generator and the resonators are exact at resonance and converge beside it."""
    assert_within((*blocks.generator_rows(), *blocks.resonator_rows()))


def test_current_loop_is_the_papers_but_for_the_phase_margin(assert_within):
    """The crossover is 610.4 Hz within the digits of K_P; the margin with delay is 73.5 degrees, not 63.5."""
    assert_within(blocks.current_loop_rows())
    found = loops.margin(loops.current_loop(1.5), 300, 2000)
    assert found.phase_deg == pytest.approx(73.5, abs=0.1)
    without = loops.margin(loops.current_loop(0), 300, 2000)
    lag = 360 * found.crossover_hz * 1.5 * loops.nominal_controller().T
    assert without.phase_deg - found.phase_deg == pytest.approx(lag, abs=1e-6)


def test_an_unstable_current_loop_shows():
    """At eight times the gain a pole of the sampled loop leaves the unit circle."""
    assert loops.largest_pole() < 1
    assert loops.largest_pole(v_dc=8 * loops.V_DC) > 1


def test_voltage_loop_has_the_papers_phase(assert_within):
    """The PI regulator has 63.5 degrees less 90 at 12.208 Hz."""
    assert_within(blocks.voltage_loop_rows())


def test_the_frequency_follows_as_theory_says(assert_within):
    """Slow loops decay with Gamma; at Gamma = 50 with the slowest mode of the whole synchronisation, about 70 1/s."""
    assert_within(blocks.lock_rows())
    assert frequency_lock.slowest_mode(50.0) == pytest.approx(70.4, abs=0.5)


def test_slowest_mode_of_a_slow_loop_is_that_of_second_order():
    """The linearised synchronisation and the loop behind a lag agree where Gamma is small."""
    assert frequency_lock.slowest_mode(2.0) == pytest.approx(frequency_lock.second_order_rate(2.0), rel=1e-3)
