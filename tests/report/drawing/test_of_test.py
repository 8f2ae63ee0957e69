import math
import pickle

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
from shown import curve, lines_of, panel_of, points

ENVELOPE = ((0.0, 0.0), (0.15, 0.0), (1.5, 0.85))
TEXTS = Texts()
NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)


@pytest.fixture(scope="module")
def drawn(make_test, make_drawing):
    """The drawing of the common test."""
    return make_drawing(make_test())


def _words(drawing):
    return {mark.words.said(TEXTS) for mark in drawing.marks if mark.words}


def _names(drawing):
    return {line.name for panel in drawing.panels for line in panel.lines}


def test_voltages_are_those_of_the_sag(drawn, scenario):
    """Phase c, 90 %: V+ is 0.7 and V- 0.3 during the sag, 1 and 0 before, one cycle late and not early."""
    for name, before, during in (("V<sup>+</sup>", 1.0, 0.7), ("V<sup>−</sup>", 0.0, 0.3)):
        t, y = curve(drawn, name)
        assert t[0] >= 0.019
        assert y[t < scenario.start_s] == pytest.approx(before, abs=2e-3)
        assert y[(t > scenario.start_s + 0.022) & (t < scenario.clear_s)] == pytest.approx(during, abs=2e-3)


def test_powers_are_in_kilo(drawn):
    """0.98 pu of current at 1 pu of voltage is 490 kW and no reactive power, at each instant and over a cycle."""
    for name, expected in (("p(t)", 490), ("q(t)", 0), ("P", 490), ("Q", 0)):
        t, y = curve(drawn, name)
        assert y[t < 0.29] == pytest.approx(expected, abs=0.5)


def test_what_is_judged_stands_out_from_what_it_is_made_of(drawn):
    """P and Q over a cycle are drawn strong and in front, the instantaneous ones pale behind them."""
    for title, names in (("Active power", ["p(t)", "P"]), ("Reactive power", ["q(t)", "Q"])):
        pale, line = panel_of(drawn, title).lines[:2]
        assert [pale.name, line.name] == names
        assert pale.opacity < 1 == line.opacity
        assert pale.width < line.width


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


def test_sag_and_windows_are_marked(drawn, scenario, make_test):
    """Start and clearing are lines through all panels; the sag and the windows of the measurements are shaded."""
    assert [m.at_s for m in drawn.marks if m.dash] == pytest.approx([scenario.start_s, scenario.clear_s])
    measured = make_test().measurements
    windows = [(part.start_s, part.end_s) for part in (measured.before, measured.during, measured.after)]
    spans = [(shade.begin_s, shade.end_s) for shade in drawn.shades]
    assert spans == [pytest.approx((scenario.start_s, scenario.clear_s)), *windows]


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


def test_opening_of_the_breaker_is_marked(make_record, make_test, make_drawing, scenario):
    """The instant at which `connected` falls has its own line and words."""
    mark = make_drawing(make_test(), make_record(scenario, opens_s=0.4)).marks[-1]
    assert mark.words.said(TEXTS) == "breaker opens 0.400 s"
    assert mark.at_s == pytest.approx(0.4, abs=1e-4)
    assert mark.dash


def test_missing_channels_leave_their_panel_out(record, make_test, make_drawing):
    """A recording of voltages alone is drawn without currents, powers and DC voltage."""
    only = {name: x for name, x in record.segments[0].channels.items() if name.startswith("u_")}
    segment = record.segments[0]
    drawn = make_drawing(make_test(), Waveforms((Segment(segment.t0_s, segment.dt_s, only),)))
    titles = [panel.title for panel in drawn.panels]
    assert titles == ["Phase-to-neutral voltages", "Sequence voltages, one cycle"]


def test_a_record_of_nothing_known_is_an_empty_drawing(make_test, make_drawing):
    """Without one known channel there is nothing to draw, and no error."""
    drawn = make_drawing(make_test(), Waveforms((Segment(0.0, 1e-3, {"x": np.zeros(10)}),)))
    assert drawn.panels == ()


def test_a_drawing_passes_from_one_process_to_another(drawn):
    """It is plain data: what is pickled comes out the same."""
    again = pickle.loads(pickle.dumps(drawn))
    assert (again.span, again.marks, again.zooms) == (drawn.span, drawn.marks, drawn.zooms)
    for name in ("u<sub>a</sub>", "V<sup>+</sup>", "limit of Q"):
        for mine, other in zip(curve(drawn, name), curve(again, name), strict=True):
            np.testing.assert_array_equal(mine, other)


def _in_two(record, at_s, times):
    """A record that goes on with a longer step, and how long that is (s)."""
    fine = record.segments[0]
    first = fine.slice(0.0, at_s)
    samples = len(first) - len(first) % times
    rest = {name: x[samples::times] for name, x in fine.channels.items()}
    cut = Segment(fine.t0_s, fine.dt_s, {name: x[:samples] for name, x in fine.channels.items()})
    return Waveforms((cut, Segment(samples * fine.dt_s, times * fine.dt_s, rest)))


@pytest.mark.parametrize("name", ["v<sub>DC</sub>", "V<sup>+</sup>", "i<sub>a</sub>"])
def test_segments_meet(record, make_test, make_drawing, name):
    """A record that goes on with a longer step is one curve in the legend, whose pieces share the sample between."""
    drawn = make_drawing(make_test(), _in_two(record, 1.0, 4), buckets=3000)
    (line,) = lines_of(drawn, name)
    first, second = line.runs
    assert (values(first.x)[-1], first.y[-1]) == (pytest.approx(values(second.x)[0], abs=1e-9), second.y[0])


def test_a_band_meets_the_curves_beside_it(record, make_test, make_drawing):
    """Where buckets are too few for curves, bands stand between them without a gap, of the same look and name."""
    drawn = make_drawing(make_test(), _in_two(record, 1.0, 4), buckets=150)
    panel = panel_of(drawn, "Phase currents")
    for name in ("i<sub>a</sub>", "i<sub>b</sub>", "largest fundamental"):
        (line,), (area,) = ([item for item in kind if item.name == name] for kind in (panel.lines, panel.areas))
        assert (area.colour, area.group, area.in_legend) == (line.colour, line.group, False)
        spans = sorted((values(x)[0], values(x)[-1]) for x, *_ in (*line.runs, *area.strips))
        ends = np.array(spans)
        assert ends[1:, 0] == pytest.approx(ends[:-1, 1], abs=1e-9)
        assert ends[0, 0] <= 0.021
        assert ends[-1, 1] == pytest.approx(drawn.span[1], abs=2e-4)


def test_where_nothing_happens_nothing_is_marked(make_record, make_test, make_drawing):
    """A run in which the grid stands still has neither lines nor shading nor zooms but the whole record."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3)
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), measurements=MeasuredWindows(), bands=())
    drawn = make_drawing(test, make_record(scenario))
    assert (drawn.marks, drawn.shades) == ((), ())
    assert [zoom.name for zoom in drawn.zooms] == ["whole record"]
    assert "ride-through envelope" not in _names(drawn)


def test_a_jump_of_the_angle_is_marked(make_record, make_test, make_drawing):
    """What is no sag has its marks, its words and its zooms, too."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3, events=[{"kind": "phase_jump", "t_s": 0.1, "angle_deg": 20}])
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), measurements=MeasuredWindows())
    drawn = make_drawing(test, make_record(scenario))
    assert [m.at_s for m in drawn.marks if m.dash] == pytest.approx([0.4])
    assert "start 0.400 s (angle)" in _words(drawn)
    assert [zoom.name for zoom in drawn.zooms] == ["whole record", "start"]


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
    assert not {"none", "of the moon"} & _names(drawn)


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


@pytest.mark.parametrize("lasts_s", [0.1, 3.0, 60.0])
@pytest.mark.parametrize("before_s", [0.3, 50.0])
def test_words_above_the_drawing_stay_in_it(make_test, make_drawing, before_s, lasts_s):
    """Whatever the record is like, no words begin left of it or end right of it, and none of the steps' overlap."""
    scenario = Scenario(sag=Sag(depth=0.5), duration_s=lasts_s, before_s=before_s)
    t = np.arange(0, scenario.end_s, 0.01)
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), bands=())
    drawn = make_drawing(test, Waveforms((Segment(0.0, 0.01, {"v_dc_v": t}),)))
    words = {mark.words.key.rpartition(".")[2]: mark for mark in drawn.marks if mark.words}
    for mark in words.values():
        share = mark.at_s / scenario.end_s
        assert share >= 0.25 or mark.anchor == "left"
        assert share <= 0.75 or mark.anchor == "right"
    apart = (words["start"].anchor, words["end"].anchor) == ("right", "left")
    assert apart or words["start"].row != words["end"].row


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
