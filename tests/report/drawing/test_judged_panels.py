"""Panels of what is judged: ripple, swings, response times and the droop, as the verdicts have them."""

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.report.drawing.model import values
from pvlvrt_compliance.report.drawing.of_test import drawing
from pvlvrt_compliance.report.language import Texts, languages
from pvlvrt_compliance.results import Band, Characteristic, Instant, Status, Verdict
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from shown import lines_of, panel_of, points

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
SPAN_S = (0.41, 0.59)
POWERS = (("active", "kw"), ("reactive", "kvar"))


def _band(quantity, name, lower, upper, **fields):
    return Band(check="mine", quantity=quantity, name=name, t_s=SPAN_S, lower=lower, upper=upper, **fields)


def test_ripple_is_drawn_about_the_line_of_its_limits(make_test, make_drawing, record):
    """In the window that was judged v_DC less the middle of the band, between half its width to either side."""
    band = _band("dc_voltage_v", "ripple", (980.0, 985.0), (984.0, 989.0), about_its_line=True)
    drawn = make_drawing(make_test(bands=(band,)))
    t_s, y = points(lines_of(drawn, "v<sub>DC</sub> less its line")[0])
    (segment,) = record
    here = np.isfinite(y)
    assert t_s[here].min() >= SPAN_S[0] - 1e-9
    assert t_s[here].max() <= SPAN_S[1] + 1e-9
    middle = np.interp(t_s[here], SPAN_S, (982.0, 987.0))
    assert y[here] == pytest.approx(np.interp(t_s[here], segment.t_s, segment["v_dc_v"]) - middle, abs=1e-6)
    _, limit = points(lines_of(drawn, "ripple")[0])
    assert set(limit[np.isfinite(limit)]) == {2.0, -2.0}
    assert "ripple" not in {line.name for line in panel_of(drawn, "DC voltage").lines}


def test_a_limit_of_the_dc_voltage_itself_stays_with_it(make_test, make_drawing):
    """Only what is about a line has a panel of its own."""
    drawn = make_drawing(make_test(bands=(_band("dc_voltage_v", "highest", None, (1100.0, 1100.0)),)))
    assert "highest" in {line.name for line in panel_of(drawn, "DC voltage").lines}
    assert "dc_ripple" not in {panel.key for panel in drawn.panels}


def test_what_swings_is_drawn_as_it_is_judged(make_test, make_drawing, make_evidence, record):
    """Means over half a cycle stand beside P or Q where a limit is of them, and nowhere else."""
    band = _band("reactive_power_kvar", "swing of Q", (90.0, 90.0), (110.0, 110.0), half_cycle=True)
    test = make_test(bands=(band,))
    drawn, evidence = make_drawing(test), make_evidence(record, test)
    (line,) = lines_of(drawn, "Q, half cycle")
    for run in line.runs:
        at = np.searchsorted(evidence.t_s, np.asarray(values(run.x)) - 1e-9)
        np.testing.assert_array_equal(run.y, evidence.half_cycle_kva.q[at])
    assert lines_of(drawn, "P, half cycle") == []
    assert lines_of(make_drawing(make_test(bands=())), "Q, half cycle") == []


def test_times_are_marked_where_they_ended(make_test, make_drawing):
    """A line at each instant, of a name once in the legend; the sentence tells the stretch nearest to a limit."""
    band = _band("reactive_current_pu", "due", (0.2, 0.2), (0.4, 0.4))
    times = [("activation", 0.310, 0.01, 0.03), ("response", 0.320, 0.02, 0.05), ("settling", 0.330, 0.02, 0.06)]
    times += [("activation", 0.510, 0.01, 0.03), ("response", 0.549, 0.049, 0.05), ("settling", 0.55, 0.04, 0.06)]
    instants = tuple(
        Instant(check="mine", quantity="reactive_current_pu", name=name, at_s=at_s, took_s=took_s, limit_s=limit_s)
        for name, at_s, took_s, limit_s in times
    )
    drawn = make_drawing(make_test(bands=(band,), instants=instants))
    panel = next(panel for panel in drawn.panels if panel.key == "reactive_current")
    found = {line.name: line for line in panel.lines}
    assert [run.x for run in found["response"].runs] == [(0.320, 0.320), (0.549, 0.549)]
    assert len({found[name].dash for name, *_ in times}) == 3
    for language in languages():
        said = panel.says.said(Texts(language))
        assert "49.0 ms" in said
        assert "20.0 ms" not in said
    assert lines_of(make_drawing(make_test(bands=(band,))), "response") == []


@pytest.fixture(scope="module")
def over_frequency(make_test, make_evidence, nominal):
    """A step to 51 Hz after which P falls from 500 kW to 420 kW, and the droop that it was held against."""
    steps = [{"kind": "frequency_step", "t_s": 0.0, "to_hz": 51.0}]
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.5, events=steps)
    dt_s = 40.9568e-6
    t = dt_s * np.arange(round(scenario.end_s / dt_s))
    after = t >= scenario.start_s
    turn = 2 * np.pi * dt_s * np.cumsum(np.where(after, 51.0, 50.0)) - 2 * np.pi / 3 * np.arange(3)[:, np.newaxis]
    share = np.where(after, 0.84, 1.0) * 500 / nominal.apparent_power_kva
    channels = dict(zip(("u_a_v", "u_b_v", "u_c_v"), nominal.phase_voltage_peak_v * np.cos(turn), strict=True))
    channels |= dict(zip(("i_a_a", "i_b_a", "i_c_a"), share * nominal.phase_current_peak_a * np.cos(turn), strict=True))
    record = Waveforms((Segment(0.0, dt_s, channels),))
    droop = Characteristic(
        check="mine",
        over="frequency_hz",
        quantity="active_power_kw",
        name="P by the droop",
        x=(50.2, 51.0),
        lower=(475.0, 395.0),
        upper=(525.0, 445.0),
    )
    verdict = Verdict(check="mine", status=Status.PASS, measured=3.0, limit=25.0, margin=22.0, unit="kW")
    fields = {"disturbance": disturbance_asked(scenario, NORMAL), "bands": (), "checks": (verdict,)}
    test = make_test(characteristics=(droop,), **fields)
    return drawing(make_evidence(record, test), test), droop


def test_power_over_frequency_beside_its_droop(over_frequency):
    """The path ends at 51 Hz and 420 kW; the limits are those of the characteristic, and the sentence the verdict's."""
    drawn, droop = over_frequency
    panel = next(panel for panel in drawn.panels if panel.key == "droop")
    assert panel.over == "other"
    f, p = points(panel.lines[0])
    assert (f[-1], p[-1]) == pytest.approx((51.0, 420.0), abs=0.05)
    assert f.min() >= 50.2 - 0.2 * 0.8 - 1e-3
    x, y = points(panel.lines[1])
    known = np.isfinite(y)
    limits = set(zip(x[known].tolist(), y[known].tolist(), strict=True))
    assert limits == {*zip(droop.x, droop.lower, strict=True), *zip(droop.x, droop.upper, strict=True)}
    assert "3.0 kW" in panel.says.said(Texts())


def test_panels_stand_beside_what_they_belong_to(over_frequency, make_test, make_drawing):
    """The droop follows the active power, the hodograph the currents."""
    keys = [panel.key for panel in over_frequency[0].panels]
    assert keys[keys.index("active_power") + 1] == "droop"
    keys = [panel.key for panel in make_drawing(make_test()).panels]
    assert keys[keys.index("currents") + 1] == "hodograph"


def test_a_limit_is_told_with_its_kind_and_its_tolerance(make_test, make_drawing):
    """What can be read off the panel comes before a time that is nearer to its limit, unless that was not kept."""
    bands = tuple(
        Band(check=check, quantity="active_power_kw", name=check, t_s=SPAN_S, lower=(0.0, 0.0))
        for check in ("level", "time")
    )
    level = Verdict(
        check="level",
        status=Status.PASS,
        measured=-1.0,
        limit=0.0,
        margin=9.0,
        tolerance=10.0,
        bound="at_least",
        unit="kW",
    )
    late = Verdict(check="time", status=Status.FAIL, measured=1.2, limit=1.0, margin=-0.2, bound="at_most", unit="s")
    near = Verdict(check="time", status=Status.PASS, measured=0.99, limit=1.0, margin=0.01, bound="at_most", unit="s")
    for time, words in ((near, "-1.0 kW (at least 0.0 kW, tolerance 10.0)"), (late, "1.200 s (at most 1.000 s)")):
        panels = make_drawing(make_test(bands=bands, checks=(level, time))).panels
        (power,) = (panel for panel in panels if panel.key == "active_power")
        assert words in power.says.said(Texts())


def test_only_a_step_that_is_seen_in_the_phases_draws_them(make_test, make_drawing):
    """Of a step of the frequency alone phase voltages are left out."""
    result = make_test()
    steps = tuple(step.model_copy(update={"moved": ("frequency",)}) for step in result.disturbance.steps)
    disturbance = result.disturbance.model_copy(update={"steps": steps})
    assert "voltages" in {panel.key for panel in make_drawing(result).panels}
    assert "voltages" not in {panel.key for panel in make_drawing(make_test(disturbance=disturbance)).panels}


def test_a_panel_does_not_tell_the_number_of_the_other_power(make_test, make_drawing):
    """A check of P and Q that reports P in kW is told beside P; beside Q the limits are described alone."""
    bands = tuple(_band(f"{name}_power_{unit}", "swing", (90.0, 90.0), (110.0, 110.0)) for name, unit in POWERS)
    verdict = Verdict(check="mine", status=Status.PASS, measured=3.0, limit=25.0, margin=22.0, unit="kW")
    panels = {panel.key: panel for panel in make_drawing(make_test(bands=bands, checks=(verdict,))).panels}
    assert panels["active_power"].says.key == "figure.active_power.kept"
    assert panels["reactive_power"].says.key == "figure.reactive_power.limits"
