import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from draws import draws
from validation.simulator import energy, invariants
from validation.simulator.records import record, without_trips

THREE_MAGNITUDES = st.tuples(*[st.floats(0, 1.1)] * 3)
THREE_ANGLES = st.tuples(*[st.floats(-0.5, 0.5)] * 3)
DRAWS = st.builds(
    invariants.Draw,
    residuals=st.builds(invariants.residual_phasors, THREE_MAGNITUDES, THREE_ANGLES),
    duration_s=st.floats(0.02, 0.4),
    point_on_wave_deg=st.floats(0, 360),
    frequency_hz=st.floats(47, 63),
    irradiance_w_m2=st.floats(0, 1200),
    cell_temperature_c=st.floats(-20, 80),
    scr=st.none() | st.floats(3, 50),
    window_start=st.floats(0, 0.9),
    window_length=st.floats(0, 1),
)
FEW = draws(10)


JUMP_IN_A_SHORT_WINDOW = invariants.Draw(
    residuals=(0j, 0j, 0j),
    duration_s=0.125,
    point_on_wave_deg=0.0,
    frequency_hz=47.0,
    irradiance_w_m2=823.0,
    cell_temperature_c=0.0,
    scr=None,
    window_start=0.40625,
    window_length=0.0,
)
"""Of 464 kW that cease within one step, half a step is a thousandth of what a cycle holds."""


@pytest.mark.slow
@given(DRAWS)
@example(JUMP_IN_A_SHORT_WINDOW)
@draws(500)
def test_any_run_is_finite_and_keeps_its_energy(draw):
    """No value is not a number, energy balances over any window to what summing samples can miss, currents sum to 0."""
    broken = invariants.broken(draw)
    assert broken.not_finite == 0
    assert broken.of_bound < 1
    assert broken.balance < invariants.BALANCE_LIMIT
    assert broken.current_sum < invariants.SUM_LIMIT


@pytest.mark.parametrize("same", [invariants.time_shift, invariants.phase_rotation, invariants.frequency_scaling])
@given(draw=DRAWS)
@FEW
def test_copies_are_alike(same, draw):
    """Later, one phase on, or at 60 Hz with all times 5/6 as long, a run is the same run."""
    assert same(draw) < invariants.COPY_LIMIT


@pytest.mark.parametrize("wrong", [{"dc_link_capacitance_f": 0.98 * 0.065}, {"filter_resistance_ohm": 0.0}])
def test_missing_energy_shows(wrong):
    """A balance that takes the link for 2 % smaller, or forgets the losses of a resistive filter, does not close."""
    draw = JUMP_IN_A_SHORT_WINDOW._replace(window_length=0.2)
    plant = {"filter_resistance_ohm": 0.01}
    parameters = without_trips(plant=plant)
    window = invariants.window_of(record(draw.scenario, parameters), draw)
    bound = energy.summing_bound(window, draw.scenario, parameters)
    assert abs(energy.unbalanced_energy(window, draw.scenario, parameters)) < bound
    assert abs(energy.unbalanced_energy(window, draw.scenario, without_trips(plant=plant | wrong))) > 10 * bound


def test_a_jump_that_is_counted_halfway_shows(monkeypatch):
    """By the trapezium rule alone, the step in which a sag begins is out of the bound in a window of a cycle."""
    assert invariants.broken(JUMP_IN_A_SHORT_WINDOW).of_bound < 0.1
    monkeypatch.setattr(energy, "jumps", lambda *_: [])
    assert invariants.broken(JUMP_IN_A_SHORT_WINDOW).of_bound > 5


def test_a_time_that_is_not_scaled_shows(monkeypatch):
    """With Gamma left as it is at 50 Hz, 60 Hz is not the same run."""
    right = invariants.scaled_in_time

    def forgetful(parameters, k):
        scaled = right(parameters, k)
        controller = scaled.controller.model_copy(update={"fll_gain": parameters.controller.fll_gain})
        return scaled.model_copy(update={"controller": controller})

    draw = invariants.draws(1)[0]
    assert invariants.frequency_scaling(draw) < invariants.COPY_LIMIT
    monkeypatch.setattr(invariants, "scaled_in_time", forgetful)
    assert invariants.frequency_scaling(draw) > 1e3 * invariants.COPY_LIMIT
