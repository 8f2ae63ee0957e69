import pytest
from hypothesis import given
from hypothesis import strategies as st

import invariants
from draws import draws
from pvlvrt_compliance.scenario.parameters import Parameters
from records import record, without_trips

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


@given(DRAWS)
@draws(500)
def test_any_run_is_finite_and_keeps_its_energy(draw):
    """No value is not a number, energy balances within 1e-3 over any window, and the currents sum to zero."""
    broken = invariants.broken(draw)
    assert broken.not_finite == 0
    assert broken.balance < invariants.BALANCE_LIMIT
    assert broken.current_sum < invariants.SUM_LIMIT


@pytest.mark.parametrize("same", [invariants.time_shift, invariants.phase_rotation, invariants.frequency_scaling])
@given(draw=DRAWS)
@FEW
def test_copies_are_alike(same, draw):
    """Later, one phase on, or at 60 Hz with all times 5/6 as long, a run is the same run."""
    assert same(draw) < invariants.COPY_LIMIT


def test_missing_energy_shows():
    """A balance that takes the link for 2 % smaller, or forgets the losses of a resistive filter, does not close."""
    draw = invariants.draws(1)[0]._replace(irradiance_w_m2=1000.0, scr=None, window_start=0.3, window_length=0.1)
    parameters = without_trips(plant={"filter_resistance_ohm": 0.01})
    window = invariants.window_of(record(draw.scenario, parameters), draw)
    energy = 500e3 * len(window) * window.dt_s
    assert abs(invariants.unbalanced_energy(window, draw.scenario, parameters)) < 1e-3 * energy
    assert abs(invariants.unbalanced_energy(window, draw.scenario, Parameters())) > 5e-3 * energy


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
