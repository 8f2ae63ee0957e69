import pickle

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.report.drawing.model import values
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from shown import curve, lines_of, names_of, panel_of

TEXTS = Texts()
NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)


def _words(drawing):
    return {mark.words.said(TEXTS) for mark in drawing.marks if mark.words}


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


def test_sag_and_windows_are_marked(drawn, scenario, make_test):
    """Start and clearing are lines through all panels; the sag and the windows of the measurements are shaded."""
    assert [m.at_s for m in drawn.marks if m.dash] == pytest.approx([scenario.start_s, scenario.clear_s])
    measured = make_test().measurements
    windows = [(part.start_s, part.end_s) for part in (measured.before, measured.during, measured.after)]
    spans = [(shade.begin_s, shade.end_s) for shade in drawn.shades]
    assert spans == [pytest.approx((scenario.start_s, scenario.clear_s)), *windows]


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
    assert "ride-through envelope" not in names_of(drawn)


def test_a_jump_of_the_angle_is_marked(make_record, make_test, make_drawing):
    """What is no sag has its marks, its words and its zooms, too."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3, events=[{"kind": "phase_jump", "t_s": 0.1, "angle_deg": 20}])
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), measurements=MeasuredWindows())
    drawn = make_drawing(test, make_record(scenario))
    assert [m.at_s for m in drawn.marks if m.dash] == pytest.approx([0.4])
    assert "start 0.400 s (angle)" in _words(drawn)
    assert [zoom.name for zoom in drawn.zooms] == ["whole record", "start"]


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
