"""Limits in the drawing of a test: each is drawn on what it is of, named once, and its worst instant pointed out."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.report.drawing.colours import VERMILION
from pvlvrt_compliance.report.drawing.model import values
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import Band, Status, Verdict
from pvlvrt_compliance.results.band import voltage_band
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from shown import curve, lines_of, names_of, panel_of, points

ENVELOPE = ((0.0, 0.0), (0.15, 0.0), (1.5, 0.85))
TEXTS = Texts()
NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)


def test_limits_are_drawn(drawn, scenario, make_test):
    """The envelope starts with the sag and holds its last value; the limit of Q spans the window it is judged in."""
    t, level = curve(drawn, "ride-through envelope")
    assert t[:3] == pytest.approx([scenario.start_s + t for t, _ in ENVELOPE])
    assert level[:3].tolist() == [u for _, u in ENVELOPE]
    t, level = curve(drawn, "limit of Q")
    during = make_test().measurements.during
    assert t.tolist() == [during.start_s, during.end_s]
    assert level.tolist() == [160.7, 160.7]
    _, peak = curve(drawn, "limit, peak")
    assert set(peak[np.isfinite(peak)]) == {2.0, -2.0}


def test_what_lies_below_an_envelope_is_shaded(drawn):
    """From zero up to the envelope, without an entry of its own in the legend."""
    (area,) = panel_of(drawn, "Sequence voltages, one cycle").areas
    t, level = curve(drawn, "ride-through envelope")
    assert list(values(area.strips[0].x)) == t.tolist()
    assert (list(area.strips[0].upper), set(area.strips[0].lower)) == (level.tolist(), {0.0})
    assert not area.in_legend


def test_the_worst_instant_of_each_check_is_pointed_out(make_test, make_drawing):
    """On the curve that its limits are of, in vermilion and with a cross where it failed; none without an instant."""
    drawn = make_drawing(make_test())
    (nearest,) = panel_of(drawn, "Phase currents").spots
    t, y = curve(drawn, "largest fundamental")
    assert (nearest.x, nearest.words.said(TEXTS)) == (0.371, "Current limit")
    assert nearest.y == pytest.approx(np.interp(0.371, t, y), abs=2e-3)
    band = _band("mine", "reactive_power_kvar", "limit of Q", 0.4, 0.6, lower=160.0)
    checks = (
        Verdict(check="mine", status=Status.FAIL, unit="kvar", at_s=0.5),
        Verdict(check="mine", status=Status.FAIL, unit="kW", at_s=0.45),
        Verdict(check="mine", status=Status.PASS, unit="kvar"),
        Verdict(check="mine", status=Status.NOT_APPLICABLE, unit="kvar", at_s=0.55),
    )
    drawn = make_drawing(make_test(bands=(band,), checks=checks))
    spots = [spot for panel in drawn.panels for spot in panel.spots if panel.over == "time"]
    assert [(spot.x, spot.words.said(TEXTS), spot.colour) for spot in spots] == [(0.5, "mine", VERMILION)]
    assert [spot.is_broken for spot in spots] == [True]
    assert not nearest.is_broken


def test_of_a_record_shorter_than_a_cycle_nothing_is_pointed_out(record, make_test, make_drawing):
    """P over a cycle is known nowhere in it; its limit is drawn beside p(t), without a worst instant."""
    (whole,) = record
    short = Waveforms((whole.slice(0.0, 0.01),))
    band = _band("mine", "active_power_kw", "limit of P", 0.0, 0.01, lower=160.0)
    checks = (Verdict(check="mine", status=Status.PASS, unit="kW", at_s=0.005),)
    panel = panel_of(make_drawing(make_test(bands=(band,), checks=checks), short), "Active power")
    assert {line.name for line in panel.lines} == {"p(t)", "limit of P"}
    assert panel.spots == ()


def test_what_is_not_judged_and_does_not_move_is_left_out(make_record, make_test, make_drawing):
    """Of a record in which nothing happens nothing is left but what is limited."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3)
    band = _band("dc", "dc_voltage_v", "my limit", 0.0, 0.3, upper=900.0)
    for bands, keys in (((), set()), ((band,), {"dc_voltage"})):
        test = make_test(
            disturbance=disturbance_asked(scenario, NORMAL), measurements=MeasuredWindows(), bands=bands, checks=()
        )
        (whole,) = make_record(scenario)
        channels = {name: x for name, x in whole.channels.items() if name.startswith("u_")}
        still = Segment(whole.t0_s, whole.dt_s, {**channels, "v_dc_v": np.full(len(whole), 834.0)})
        assert {panel.key for panel in make_drawing(test, Waveforms((still,))).panels} == keys
    moving = make_drawing(make_test(bands=(), checks=()))
    assert {"voltages", "sequences", "currents", "active_power", "dc_voltage"} <= {panel.key for panel in moving.panels}


def test_the_voltage_that_an_envelope_is_of_is_drawn_with_it(make_test, make_drawing):
    """Phase c at 0.1 pu: the lowest line-to-line voltage is 0.608 pu, and stands beside V+ and V- in one panel."""
    name = voltage_band("lowest_line_to_line")
    band = Band(check="ride_through", quantity=name, name="ride-through envelope", t_s=(0.3, 1.7), lower=(0.0, 0.85))
    unknown = Band(check="mine", quantity="voltage_of_the_moon_pu", name="none", t_s=(0.0,), lower=(0.0,))
    drawn = make_drawing(make_test(bands=(band, unknown)))
    t, y = curve(drawn, "lowest line to line")
    assert y[(t > 0.33) & (t < 0.6)] == pytest.approx(abs(np.exp(2j * np.pi / 3) * 0.1 - 1) / np.sqrt(3), abs=2e-3)
    here = {line.name for line in panel_of(drawn, "One-cycle voltages").lines}
    assert {"V<sup>+</sup>", "lowest line to line", "ride-through envelope"} <= here
    assert not {"none", "of the moon"} & names_of(drawn)


def test_what_is_limited_has_its_panel(make_test, make_drawing):
    """Frequency, reactive currents and their share are drawn where a limit is of them, and else not."""
    titles = {
        "frequency_hz": "Frequency",
        "reactive_current_pu": "Reactive currents of the sequences, one cycle",
        "reactive_current_negative_pu": "Reactive currents of the sequences, one cycle",
        "reactive_share": "Share of the reactive current",
    }
    for quantity, title in titles.items():
        band = Band(check="mine", quantity=quantity, name="my limit", t_s=(0.0, 1.0), lower=(0.1, 0.1))
        drawn = make_drawing(make_test(bands=(band,)))
        (panel,) = [panel for panel in drawn.panels if panel.title in titles.values()]
        assert (panel.title, len(panel.lines)) == (title, 2)
    assert not {panel.title for panel in make_drawing(make_test()).panels} & set(titles.values())


def _band(check, quantity, name, begin_s, end_s, **edges):
    lines = {edge: (value, value) for edge, value in edges.items()}
    return Band(check=check, quantity=quantity, name=name, t_s=(begin_s, end_s), **lines)


def test_a_band_of_another_check_is_drawn(make_test, make_drawing):
    """A drawing shows what any check gives, by what it limits and not by the check's name."""
    band = Band(
        check="mine", quantity="dc_voltage_v", name="my limit", t_s=(0.0, 1.0), lower=(700, 700), upper=(900, 950)
    )
    t, y = curve(make_drawing(make_test(bands=(band,))), "my limit")
    assert t.tolist() == [0.0, 1.0, 1.0, 1.0, 0.0]
    assert [None if math.isnan(level) else level for level in y] == [900, 950, None, 700, 700]


def test_every_band_is_drawn_and_named_once(make_test, make_drawing):
    """A limit for each stretch: all are drawn, alike and under one name, and those of another name look otherwise."""
    stretches = ((0.35, 0.6), (0.65, 0.9), (0.95, 1.2))
    given = [
        ("current_limit", "current_pu", "limit, fundamental", {"lower": -1.02, "upper": 1.02}),
        ("current_limit", "current_pu", "limit, first cycles", {"lower": -1.2, "upper": 1.2}),
        ("reactive_support", "reactive_power_kvar", "limit of Q", {"lower": 150.0}),
        ("active_power_support", "active_power_kw", "limit of P", {"lower": 300.0}),
        ("oscillation", "active_power_kw", "swing of P", {"lower": 275.0, "upper": 325.0}),
        ("dc_limit", "dc_voltage_v", "limit of the DC voltage", {"upper": 1100.0}),
    ]
    bands = tuple(_band(check, on, name, *span, **edges) for check, on, name, edges in given for span in stretches)
    drawn = make_drawing(make_test(bands=bands))
    looks = {}
    for _, on, name, _ in given:
        lines = [line for panel in drawn.panels if panel.over == "time" for line in panel.lines if line.name == name]
        assert [(points(line)[0][0], max(points(line)[0])) for line in lines] == list(stretches)
        assert [line.in_legend for line in lines] == [True, False, False]
        assert len({line.group for line in lines}) == 1
        ((dash, colour),) = {(line.dash, line.colour) for line in lines}
        assert looks.setdefault((on.rpartition("_")[0][-5:], dash, colour), name) == name
    assert len(looks) == len(given)


def test_a_limit_stands_beside_the_same_with_its_tolerance(make_test, make_drawing):
    """Both have one name, one dash and one entry in the legend; the one with the tolerance is thinner."""
    plain = _band("reactive_support", "reactive_power_kvar", "limit of Q", 0.4, 0.6, lower=160.0)
    widened = plain.model_copy(update={"lower": (150.0, 150.0), "widened": True})
    lines = lines_of(make_drawing(make_test(bands=(widened, plain))), "limit of Q")
    assert [(line.runs[0].y, line.in_legend) for line in lines] == [((160.0, 160.0), True), ((150.0, 150.0), False)]
    assert lines[0].width > lines[1].width
    assert len({(line.dash, line.colour, line.group) for line in lines}) == 1


def test_a_region_is_an_area_of_its_mode(make_test, make_drawing):
    """Regions are filled, those of one mode alike, and stand in the legend once each."""
    common = {"check": "ride_through", "quantity": "voltage_positive_pu", "t_s": (0.3, 0.9)}
    given = [("mandatory", 0.5), ("mandatory", 0.7), ("permissive", 0.2)]
    bands = tuple(
        Band(name=f"{mode} {u}", region=mode, lower=(u, u), upper=(u + 0.1, u + 0.1), **common) for mode, u in given
    )
    areas = panel_of(make_drawing(make_test(bands=bands)), "Sequence voltages, one cycle").areas
    assert [(area.strips[0].lower[0], area.in_legend) for area in areas] == [(0.5, True), (0.7, True), (0.2, True)]
    assert areas[0].colour == areas[1].colour != areas[2].colour
