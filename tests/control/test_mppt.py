import pytest

from pvlvrt_compliance.control.mppt import MpptParams, mppt_step, searching_from
from pvlvrt_compliance.kernel import plain
from pvlvrt_compliance.plant import pv_array

step = plain(mppt_step)
P = MpptParams(period=6, dv=0.5, v_min=600.0, v_max=1000.0)


@pytest.fixture(scope="module")
def array():
    """The array of the paper at 25 degrees C."""
    return pv_array.fit(pv_array.STP320_24_VE, 25.0, 22, 72)


def search(x, periods, current, p=P):
    """Let the search run on an array whose voltage follows v* at once."""
    for _ in range(periods * p.period):
        x = step(x, x.v_ref, current(x.v_ref), False, p)
    return x


@pytest.mark.parametrize("irradiance", [200.0, 600.0, 1000.0])
@pytest.mark.parametrize("start", [-40.0, 30.0])
def test_the_search_ends_at_the_maximum_power_point(array, irradiance, start):
    """From either side it comes within two perturbations of the maximum, and stays there."""
    best = pv_array.maximum_power_point(irradiance, array)
    x = search(searching_from(best.v + start), 110, lambda v: pv_array.current_at(v, irradiance, array))
    for _ in range(12):
        x = search(x, 1, lambda v: pv_array.current_at(v, irradiance, array))
        assert abs(x.v_ref - best.v) <= 2 * P.dv + 0.3


def test_it_finds_the_top_of_a_parabola():
    """Power (v - 550)(950 - v) is largest at 750 V."""
    x = search(searching_from(700.0), 150, lambda v: (v - 550) * (950 - v) / v)
    assert abs(x.v_ref - 750) <= 2 * P.dv


def test_the_voltage_holds_while_power_is_limited():
    """With P* at its limit v*_DC does not move, and the search afterwards compares nothing from before."""
    x = search(searching_from(800.0), 5, lambda v: 1e5 / v)
    held = x.v_ref
    for k in range(1000):
        x = step(x, 900.0 + k, 10.0, True, P)
    assert x.v_ref == held
    assert x.P_before < 0
    direction = x.direction
    x = search(x, 1, lambda _: 0.0)
    assert x.v_ref == held + direction * P.dv


@pytest.mark.parametrize(("slope", "end"), [(1.0, 1000.0), (-1.0, 600.0)])
def test_the_voltage_stays_within_its_range(slope, end):
    """A curve that only rises, or only falls, leads to the end of the range and not beyond it."""
    x = search(searching_from(800.0), 500, lambda v: (2000 + slope * v) / v)
    assert abs(x.v_ref - end) <= 2 * P.dv
    assert P.v_min <= x.v_ref <= P.v_max


def test_power_is_averaged_over_the_second_half_of_a_period():
    """What the link does right after a perturbation does not count."""
    x = searching_from(800.0)
    for k in range(P.period):
        x = step(x, 800.0, 1e6 if k < P.period // 2 else 100.0, False, P)
    assert x.P_before == pytest.approx(80e3)
