"""Paths in a plane against closed forms: balanced currents are circles, unbalanced ones ellipses, an array a line."""

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.report.drawing.orbits import array_path, hodograph, sketched_path
from pvlvrt_compliance.report.drawing.spans import span_of
from pvlvrt_compliance.results import Band
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from shown import points

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
POSITIVE, NEGATIVE = 0.7, 0.2


@pytest.fixture(scope="module")
def unbalanced(scenario, nominal):
    """A record with a balanced current of 0.98 pu before and after, and both sequences during the sag."""
    t = 40.9568e-6 * np.arange(round((scenario.end_s + 1.0) / 40.9568e-6))
    during = (t >= scenario.start_s) & (t < scenario.clear_s)
    turn = 2 * np.pi * 50 * t - 2 * np.pi / 3 * np.arange(3)[:, np.newaxis]
    back = 2 * np.pi * 50 * t + 2 * np.pi / 3 * np.arange(3)[:, np.newaxis]
    i = np.where(during, POSITIVE * np.cos(turn) + NEGATIVE * np.cos(back), 0.98 * np.cos(turn))
    channels = dict(zip(("i_a_a", "i_b_a", "i_c_a"), i * nominal.phase_current_peak_a, strict=True))
    channels |= dict(zip(("u_a_v", "u_b_v", "u_c_v"), nominal.phase_voltage_peak_v * np.cos(turn), strict=True))
    v_dc = np.where(during, 900.0 + 20 * np.sin(2 * np.pi * 100 * t), 850.0)
    channels |= {"v_dc_v": v_dc, "i_pv_a": (500e3 - 4e3 * (v_dc - 850.0)) / v_dc, "connected": np.ones_like(t)}
    return Waveforms((Segment(0.0, 40.9568e-6, channels),))


@pytest.fixture(scope="module")
def seen(unbalanced, make_test, make_evidence):
    """What is known of it, and its result."""
    test = make_test()
    return make_evidence(unbalanced, test), test


def _lines(panel):
    return {line.name: points(line) for line in panel.lines}


def test_balanced_current_runs_along_a_circle_and_unbalanced_along_an_ellipse(seen):
    """Before and after the radius is the amplitude; during it the half axes are the sequences' sum and difference."""
    lines = _lines(hodograph(*seen))
    for name in ("before", "after"):
        assert np.hypot(*lines[name]) == pytest.approx(0.98, abs=2e-3)
    radius = np.hypot(*lines["during"])
    assert (radius.min(), radius.max()) == pytest.approx((POSITIVE - NEGATIVE, POSITIVE + NEGATIVE), abs=3e-3)
    x, y = lines["during"]
    assert (x.max(), y.max()) == pytest.approx((POSITIVE + NEGATIVE, POSITIVE - NEGATIVE), abs=3e-3)  # alpha is phase a


def test_limits_are_circles_as_large_as_what_was_judged(seen):
    """Each limit of the current once, at the level of its band; around all of it axes of the same length."""
    panel = hodograph(*seen)
    lines = _lines(panel)
    for band in (band for band in seen[1].bands if band.quantity == "current_pu"):
        assert np.hypot(*lines[band.name]) == pytest.approx(band.upper[0], abs=1e-3)
    assert panel.equal
    assert span_of(panel)[0] == span_of(panel)[1] == pytest.approx((-2.12, 2.12))
    assert panel.says.key == "figure.hodograph.limits"


def test_without_a_limit_there_is_no_circle(seen):
    """The current is shown, and the sentence says nothing of limits."""
    evidence, test = seen
    panel = hodograph(evidence, test.model_copy(update={"bands": ()}))
    assert {line.name for line in panel.lines} == {"before", "first cycles", "during", "after"}
    assert panel.says.key == "figure.hodograph.seen"


def test_no_hodograph_where_the_voltage_stays(unbalanced, make_test, make_evidence):
    """Where only the frequency moves nothing is to be seen in it, nor in a record without currents."""
    steps = [{"kind": "frequency_step", "t_s": 0.2, "to_hz": 50.5}]
    still = make_test(disturbance=disturbance_asked(Scenario(sag=Sag(depth=0), duration_s=0.4, events=steps), NORMAL))
    assert hodograph(make_evidence(unbalanced, still), still) is None
    (segment,) = unbalanced
    voltages = {name: x for name, x in segment.channels.items() if name.startswith("u_")}
    bare, test = Waveforms((Segment(segment.t0_s, segment.dt_s, voltages),)), make_test()
    assert hodograph(make_evidence(bare, test), test) is None
    assert array_path(make_evidence(bare, test), test) is None


def test_the_array_runs_along_its_line(seen):
    """Its power falls by 4 kW a volt here: every point of the path lies on that, and its ends are where they were."""
    panel = array_path(*seen)
    for v, p in _lines(panel).values():
        assert p == pytest.approx(500 - 4 * (v - 850), abs=0.3)
    v, _ = _lines(panel)["during"]
    assert (v.min(), v.max()) == pytest.approx((880, 920), abs=0.3)
    before, during = panel.spots
    assert (before.x, before.y) == pytest.approx((850, 500), abs=0.1)
    assert during.y == pytest.approx(500 - 4 * (during.x - 850), abs=0.3)
    low, high = panel.x.span
    assert low < before.x < during.x < high, "a point at an end is not cut in half"


def test_an_array_that_keeps_its_power_is_not_drawn(unbalanced, make_test, make_evidence):
    """Less than a twentieth of the rated power is no path."""
    (segment,) = unbalanced
    still = {**segment.channels, "i_pv_a": 500e3 / segment["v_dc_v"] + 20 * np.sin(segment.t_s)}
    record, test = Waveforms((Segment(segment.t0_s, segment.dt_s, still),)), make_test()
    assert array_path(make_evidence(record, test), test) is None


@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_a_path_is_short_and_near_its_samples(noise):
    """Of 20 000 samples some hundreds are left at most; without noise none is further than 0.2 % from the path."""
    t = np.linspace(0, 1, 20_000)
    x = np.cos(2 * np.pi * 3 * t) + noise * np.sin(2 * np.pi * 2000 * t)
    y = 40 * np.sin(2 * np.pi * 3 * t)
    kept = sketched_path(x, y)
    assert len(kept) <= 250
    if not noise:
        for series in (x, y):
            off = np.abs(np.interp(t, t[kept], series[kept]) - series)
            assert off.max() <= 2e-3 * np.ptp(series) + 1e-9


def test_a_band_of_another_quantity_is_no_circle(seen):
    """Only limits of the current are drawn in its plane."""
    evidence, test = seen
    other = Band(check="mine", quantity="active_power_kw", name="mine", t_s=(0.0, 1.0), lower=(3.0, 3.0))
    panel = hodograph(evidence, test.model_copy(update={"bands": (other,)}))
    assert "mine" not in _lines(panel)


def test_after_a_trip_the_current_is_gone(unbalanced, make_test, make_evidence, scenario):
    """The cycle during the sag is the last one before the trip, and there is none after it."""
    (segment,) = unbalanced
    opened_s = scenario.start_s + 0.15
    closed = (segment.t_s < opened_s).astype(float)
    channels = {name: x * closed if name.startswith("i_") else x for name, x in segment.channels.items()}
    record, test = Waveforms((Segment(segment.t0_s, segment.dt_s, channels | {"connected": closed}),)), make_test()
    panel = hodograph(make_evidence(record, test), test)
    lines = _lines(panel)
    assert "after" not in lines
    assert np.hypot(*lines["during"])[:-1].min() == pytest.approx(POSITIVE - NEGATIVE, abs=3e-3)
    assert float(panel.says.values["end"]) == pytest.approx(opened_s, abs=1e-3)
