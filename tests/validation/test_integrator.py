import pytest

from validation.simulator import integrator


@pytest.mark.parametrize("name", integrator.CASES)
@pytest.mark.parametrize("centre", ["start", "clear"])
def test_scipy_gives_the_same_run_in_closed_loop(name, centre, assert_within):
    """60 ms around the start and the end of a sag agree within 0.2 % of nominal, rms."""
    compared = integrator.compare(integrator.CASES[name], centre)
    assert len(compared.t) == pytest.approx(0.06 / 40.9568e-6, abs=1)
    assert_within(integrator.rows({name: compared}))


@pytest.mark.parametrize("changed", [{"L": 0.18e-3}, {"C": 0.05}])
def test_another_plant_shows(changed):
    """A plant of another inductance or capacitance is not within the tolerance, though the loop is closed."""
    compared = integrator.compare(integrator.CASES["three-phase 90 %"], "start", **changed)
    assert max(compared.current_percent, compared.voltage_percent) > integrator.LIMIT_PERCENT
