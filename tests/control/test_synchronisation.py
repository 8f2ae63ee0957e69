"""What all synchronisations have in common, and what tells them apart; open loop, on samples of a voltage vector."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.control.synchronisation import SynchronisationState

U = math.sqrt(3) * 230
T_REG = 40.9568e-6
ALGORITHMS = ("msogi-fll", "dsogi-fll", "srf-pll", "ddsrf-pll", "dsc-pll")
LAST = slice(-2000, None)

every = pytest.mark.parametrize("algorithm", ALGORITHMS)


def vector(frequency_hz: float, seconds: float, parts: dict[int, complex]) -> np.ndarray:
    """Samples of a sum of turning vectors (V) by signed harmonic order: -1 is the negative sequence."""
    angle = 2 * np.pi * frequency_hz * T_REG * np.arange(round(seconds / T_REG))
    return sum(u * np.exp(1j * h * angle) for h, u in parts.items())


@pytest.fixture(scope="module")
def chosen(track):
    """Give ``chosen(algorithm, u, start_hz) -> Track``."""
    return lambda algorithm, u, start_hz: track(u, start_hz, f"synchronisation={algorithm}")


def ripple_hz(w: np.ndarray) -> float:
    """Half peak-to-peak of the estimated frequency at the end."""
    return 0.5 * np.ptp(w[LAST]) / (2 * math.pi)


@every
@pytest.mark.parametrize("frequency_hz", [47.0, 50.0, 52.0, 60.0])
def test_it_starts_locked(chosen, algorithm, frequency_hz):
    """From its first sample on it gives the voltage, at that sample, and its frequency."""
    u = vector(frequency_hz, 0.1, {1: U})
    found = chosen(algorithm, u, frequency_hz)
    assert np.allclose(found.u_pos, u, atol=1e-4 * U)
    assert np.allclose(found.u_neg, 0, atol=1e-4 * U)
    assert np.allclose(found.w, 2 * math.pi * frequency_hz, rtol=1e-7)


@every
@pytest.mark.parametrize(("start_hz", "frequency_hz"), [(50, 45), (50, 47), (50, 52), (50, 55), (60, 57), (60, 62)])
@pytest.mark.many_samples
def test_it_locks_to_the_frequency_of_the_grid(chosen, algorithm, start_hz, frequency_hz):
    """From nominal frequency it finds another within 0.05 Hz in 110 ms, and the voltage without error."""
    u = vector(frequency_hz, 0.5, {1: U})
    found = chosen(algorithm, u, start_hz)
    off = np.abs(found.w / (2 * np.pi) - frequency_hz)
    assert off[round(0.11 / T_REG) :].max() < 0.05
    assert off[-1] < 1e-4
    assert abs(found.u_pos[-1] - u[-1]) < 1e-4 * U


@every
@pytest.mark.parametrize("frequency_hz", [50, 60])
@pytest.mark.many_samples
def test_sequences_of_an_unbalanced_voltage_are_exact(chosen, algorithm, frequency_hz):
    """Both sequences of a sag of one phase come out with their angles, without ripple of the frequency."""
    positive, negative = 0.7 * U, 0.3 * U * np.exp(0.4j)
    found = chosen(algorithm, vector(frequency_hz, 0.6, {1: positive, -1: negative}), frequency_hz)
    assert np.allclose(found.u_pos[LAST], vector(frequency_hz, 0.6, {1: positive})[LAST], atol=1e-4 * U)
    assert np.allclose(found.u_neg[LAST], vector(frequency_hz, 0.6, {-1: negative})[LAST], atol=1e-4 * U)
    assert ripple_hz(found.w) < 1e-4


@pytest.mark.parametrize(
    ("algorithm", "limit_ms"),
    [("msogi-fll", 18), ("dsogi-fll", 21), ("srf-pll", 9), ("ddsrf-pll", 13), ("dsc-pll", 5.5)],
)
def test_how_fast_it_finds_the_positive_sequence(chosen, algorithm, limit_ms):
    """After a sag of one phase u+ is right within 2 % of nominal in this time."""
    parts = {1: 0.7 * U, -1: 0.3 * U}
    found = chosen(algorithm, vector(50, 0.3, parts), 50)
    wrong = np.nonzero(np.abs(found.u_pos - vector(50, 0.3, {1: 0.7 * U})) > 0.02 * U)[0]
    assert wrong[-1] * T_REG < 1e-3 * limit_ms


@pytest.mark.parametrize("phase", [1, -1])
@pytest.mark.many_samples
def test_only_the_decoupling_network_is_free_of_harmonics(chosen, phase):
    """With 10 % of 5th and 7th the frequency of the DSOGI-FLL ripples and that of the MSOGI-FLL does not."""
    u = vector(50, 1.0, {1: U, -5: 0.1 * U, 7: 0.1 * phase * U})
    error = {name: np.abs(chosen(name, u, 50).u_pos - vector(50, 1.0, {1: U}))[LAST].max() for name in ALGORITHMS[:2]}
    assert error["msogi-fll"] < 1e-6 * U
    assert error["dsogi-fll"] > 0.02 * U
    assert ripple_hz(chosen("msogi-fll", u, 50).w) < 1e-6
    # In phase the two orders nearly cancel in the error of the FLL; in antiphase they add.
    assert ripple_hz(chosen("dsogi-fll", u, 50).w) > (0.005 if phase > 0 else 0.15)


@pytest.mark.parametrize(("algorithm", "percent"), [("srf-pll", 17.6), ("ddsrf-pll", 3.2), ("dsc-pll", 0.0)])
@pytest.mark.many_samples
def test_what_harmonics_do_to_the_others(chosen, algorithm, percent):
    """The largest error of u+ with 10 % of 5th and 7th in antiphase: a quarter of a cycle cancels both in u+."""
    u = vector(50, 1.0, {1: U, -5: 0.1 * U, 7: -0.1 * U})
    error = np.abs(chosen(algorithm, u, 50).u_pos - vector(50, 1.0, {1: U}))[LAST].max()
    assert 100 * error / U == pytest.approx(percent, abs=0.1)


def test_a_quarter_of_a_cycle_hands_5th_and_7th_to_the_negative_sequence(chosen):
    """What cancels in u+ stands in u- with all of its amplitude."""
    u = vector(50, 1.0, {1: U, -5: 0.1 * U, 7: 0.1 * U})
    assert np.abs(chosen("dsc-pll", u, 50).u_neg)[LAST].max() == pytest.approx(0.2 * U, rel=1e-3)


@every
@pytest.mark.parametrize("frequency_hz", [30, 90])
@pytest.mark.many_samples
def test_the_estimate_stays_within_its_guard(chosen, algorithm, frequency_hz):
    """A voltage beyond 40 to 70 Hz leaves the estimate within them."""
    found = chosen(algorithm, vector(frequency_hz, 1.0, {1: U}), 50).w / (2 * np.pi)
    assert found.min() >= 40 - 1e-9
    assert found.max() <= 70 + 1e-9


@every
@pytest.mark.many_samples
def test_without_voltage_the_estimate_stays_finite_and_guarded(chosen, algorithm):
    """A dead grid, 0/0 in every normalisation, gives no number that is not one."""
    found = chosen(algorithm, np.zeros(20000, complex), 50)
    assert np.isfinite(found.w).all()
    assert np.isfinite(found.u_neg).all()
    assert 40 - 1e-9 <= found.w.min() / (2 * math.pi) <= found.w.max() / (2 * math.pi) <= 70 + 1e-9
    assert abs(found.u_pos[-1]) < 1e-6 * U


def test_decoupled_frames_at_the_right_angle_are_a_generator(track):
    """With a loop that hardly moves, the DDSRF has the sequences of a DSOGI with K = 2 w_f/w, in transients too."""
    u = vector(50, 0.1, {1: 0.7 * U, -1: 0.3 * U, -5: 0.1 * U})
    frames = track(u, 50, "synchronisation=ddsrf-pll", "pll_bandwidth_hz=0.01", "ddsrf_filter_ratio=0.5")
    generator = track(u, 50, "synchronisation=dsogi-fll", K=1.0, gamma=0.0)
    assert np.abs(frames.u_pos - generator.u_pos).max() < 0.01 * U
    assert np.abs(frames.u_neg - generator.u_neg).max() < 0.01 * U


@every
def test_only_the_chosen_one_is_there(chosen, algorithm):
    """A run has the state of its own synchronisation and of no other."""
    after = chosen(algorithm, vector(51, 0.02, {1: 0.5 * U}), 50).state
    there = {name for name in SynchronisationState._fields if getattr(after, name) is not None}
    assert there == {algorithm.partition("-")[0]}
