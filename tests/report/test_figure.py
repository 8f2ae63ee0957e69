import base64
import itertools
import json

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.report import figure
from pvlvrt_compliance.results import Band
from pvlvrt_compliance.results.band import voltage_band
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

ENVELOPE = ((0.0, 0.0), (0.15, 0.0), (1.5, 0.85))
NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)


@pytest.fixture(scope="module")
def drawn(make_test, make_figure):
    """The figure of the common test."""
    return make_figure(make_test())


def _points(trace):
    y = np.frombuffer(base64.b64decode(trace["y"]["bdata"]), trace["y"]["dtype"])
    return trace["x0"] + trace["dx"] * np.arange(len(y)), y


def _named(drawn, name):
    return next(trace for trace in drawn["data"] if trace["name"] == name)


def test_all_panels_share_one_time_axis(drawn):
    """Zoom in one panel is zoom in all; every panel has its own values and legend, and none overlaps another."""
    assert {trace["xaxis"] for trace in drawn["data"]} == {"x"}
    axes = sorted({trace["yaxis"] for trace in drawn["data"]})
    assert axes == ["y", "y2", "y3", "y4", "y5"]
    domains = sorted(drawn["layout"][name.replace("y", "yaxis")]["domain"] for name in axes)
    assert all(below[1] < above[0] for below, above in itertools.pairwise(domains))
    assert domains[0][0] == 0
    assert domains[-1][1] == 1


def test_voltages_are_those_of_the_sag(drawn, scenario):
    """Phase c, 90 %: V+ is 0.7 and V- 0.3 during the sag, 1 and 0 before, one cycle late and not early."""
    for name, before, during in (("V<sup>+</sup>", 1.0, 0.7), ("V<sup>−</sup>", 0.0, 0.3)):
        t, y = _points(_named(drawn, name))
        assert t[0] >= 0.019
        assert y[t < scenario.start_s] == pytest.approx(before, abs=2e-3)
        assert y[(t > scenario.start_s + 0.022) & (t < scenario.clear_s)] == pytest.approx(during, abs=2e-3)


def test_powers_are_in_kilo(drawn):
    """0.98 pu of current at 1 pu of voltage is 490 kW and no reactive power."""
    for name, expected in (("P", 490), ("Q", 0)):
        t, y = _points(_named(drawn, name))
        assert y[t < 0.29] == pytest.approx(expected, abs=0.5)


def test_limits_are_drawn(drawn, scenario, make_test):
    """The envelope starts with the sag and holds its last value; the limit of Q spans the window it is judged in."""
    envelope = _named(drawn, "ride-through envelope")
    assert envelope["x"][:3] == pytest.approx([scenario.start_s + t for t, _ in ENVELOPE])
    assert envelope["y"][:3] == [u for _, u in ENVELOPE]
    demanded = _named(drawn, "limit of Q")
    during = make_test().measurements.during
    assert demanded["x"] == [during.start_s, during.end_s]
    assert demanded["y"] == [160.7, 160.7]
    assert set(_named(drawn, "limit, peak")["y"]) == {2.0, None, -2.0}


def test_sag_and_window_are_marked(drawn, scenario, make_test):
    """Start and clearing are lines through all panels; the sag and the window `during` are shaded."""
    shapes = drawn["layout"]["shapes"]
    assert [s["x0"] for s in shapes if s["type"] == "line"] == pytest.approx([scenario.start_s, scenario.clear_s])
    spans = [(s["x0"], s["x1"]) for s in shapes if s["type"] == "rect"]
    during = make_test().measurements.during
    assert spans == [pytest.approx((scenario.start_s, scenario.clear_s)), (during.start_s, during.end_s)]


def test_opening_of_the_breaker_is_marked(make_record, make_test, scenario, nominal):
    """The instant at which `connected` falls has its own line and words."""
    drawn = figure.test_figure(make_record(scenario, opens_s=0.4), make_test(), nominal)
    assert any("breaker opens 0.400 s" in note["text"] for note in drawn["layout"]["annotations"])
    lines = [s["x0"] for s in drawn["layout"]["shapes"] if s["type"] == "line"]
    assert lines[-1] == pytest.approx(0.4, abs=1e-4)


def test_it_is_small_plain_json(drawn):
    """27 figures fit into one report: under 200 kB each, and no number that JSON does not know."""
    assert len(json.dumps(drawn, allow_nan=False)) < 200_000


def test_missing_channels_leave_their_panel_out(record, make_test, nominal):
    """A recording of voltages alone is drawn without currents, powers and DC voltage."""
    only = {name: x for name, x in record.segments[0].channels.items() if name.startswith("u_")}
    segment = record.segments[0]
    drawn = figure.test_figure(Waveforms((Segment(segment.t0_s, segment.dt_s, only),)), make_test(), nominal)
    titles = [note["text"] for note in drawn["layout"]["annotations"] if note["text"].startswith("<b>")]
    assert titles == ["<b>Phase-to-neutral voltages</b>", "<b>Sequence voltages, one cycle</b>"]


def test_a_record_of_nothing_known_is_an_empty_figure(make_test, nominal):
    """Without one known channel there is nothing to draw, and no error."""
    drawn = figure.test_figure(Waveforms((Segment(0.0, 1e-3, {"x": np.zeros(10)}),)), make_test(), nominal)
    assert drawn["data"] == []


def test_segments_are_drawn_on_their_own_steps(record, make_test, nominal):
    """A record that goes on with a longer step is one curve in the legend, in two pieces that meet."""
    fine = record.segments[0]
    cut = fine.slice(0.0, 1.0)
    rest = fine.slice(1.0, 2.0)
    thin = Segment(rest.t0_s, 4 * rest.dt_s, {name: x[::4] for name, x in rest.channels.items()})
    drawn = figure.test_figure(Waveforms((cut, thin)), make_test(), nominal)
    pieces = [trace for trace in drawn["data"] if trace["name"] == "v<sub>DC</sub>"]
    assert [piece["showlegend"] for piece in pieces] == [True, False]
    assert pieces[1]["x0"] == pytest.approx(_points(pieces[0])[0][-1], abs=2e-3)


def test_sequence_voltages_go_on_across_a_change_of_step(record, make_test, nominal):
    """The one-cycle voltages of the second piece begin where the first ends, not a cycle later."""
    fine = record.segments[0]
    cut = fine.slice(0.0, 1.0)
    rest = fine.slice(1.0, 2.0)
    thin = Segment(rest.t0_s, 4 * rest.dt_s, {name: x[::4] for name, x in rest.channels.items()})
    drawn = figure.test_figure(Waveforms((cut, thin)), make_test(), nominal)
    first, second = (trace for trace in drawn["data"] if trace["name"] == "V<sup>+</sup>")
    assert second["x0"] == pytest.approx(_points(first)[0][-1], abs=2e-3)


def test_where_nothing_happens_nothing_is_marked(make_record, make_test, nominal):
    """A run in which the grid stands still has neither lines nor shading nor zoom buttons but the whole record."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3)
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), measurements=MeasuredWindows(), bands=())
    drawn = figure.test_figure(make_record(scenario), test, nominal)
    assert not drawn["layout"]["shapes"]
    assert [button["label"] for button in drawn["layout"]["updatemenus"][0]["buttons"]] == ["whole record"]
    assert "ride-through envelope" not in {trace["name"] for trace in drawn["data"]}


def test_a_jump_of_the_angle_is_marked(make_record, make_test, nominal):
    """What is no sag has its marks, its words and its zoom buttons, too."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3, events=[{"kind": "phase_jump", "t_s": 0.1, "angle_deg": 20}])
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), measurements=MeasuredWindows())
    drawn = figure.test_figure(make_record(scenario), test, nominal)
    assert [s["x0"] for s in drawn["layout"]["shapes"] if s["type"] == "line"] == pytest.approx([0.4])
    assert any(note["text"] == "start 0.400 s (angle)" for note in drawn["layout"]["annotations"])
    assert [button["label"] for button in drawn["layout"]["updatemenus"][0]["buttons"]] == ["whole record", "start"]


def test_the_voltage_that_an_envelope_is_of_is_drawn_with_it(record, make_test, nominal):
    """Phase c at 0.1 pu: the lowest line-to-line voltage is 0.608 pu, and stands beside V+ and V- in one panel."""
    name = voltage_band("lowest_line_to_line")
    band = Band(check="ride_through", quantity=name, name="ride-through envelope", t_s=(0.3, 1.7), lower=(0.0, 0.85))
    unknown = Band(check="mine", quantity="voltage_of_the_moon_pu", name="none", t_s=(0.0,), lower=(0.0,))
    drawn = figure.test_figure(record, make_test(bands=(band, unknown)), nominal)
    t, y = _points(_named(drawn, "lowest line to line"))
    assert y[(t > 0.33) & (t < 0.6)] == pytest.approx(abs(np.exp(2j * np.pi / 3) * 0.1 - 1) / np.sqrt(3), abs=2e-3)
    envelope = _named(drawn, "ride-through envelope")
    assert (envelope["x"], envelope["yaxis"]) == ([0.3, 1.7], _named(drawn, "lowest line to line")["yaxis"])
    assert not {"none", "of the moon"} & {trace["name"] for trace in drawn["data"]}


@pytest.mark.parametrize("lasts_s", [0.1, 3.0, 60.0])
@pytest.mark.parametrize("before_s", [0.3, 50.0])
def test_words_above_the_figure_stay_in_it(make_test, nominal, before_s, lasts_s):
    """Whatever the record is like, no words begin left of it or end right of it, and none of the steps' overlap."""
    scenario = Scenario(sag=Sag(depth=0.5), duration_s=lasts_s, before_s=before_s)
    t = np.arange(0, scenario.end_s, 0.01)
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), bands=())
    drawn = figure.test_figure(Waveforms((Segment(0.0, 0.01, {"v_dc_v": t}),)), test, nominal)
    words = {note["text"].split()[0]: note for note in drawn["layout"]["annotations"] if "(voltage)" in note["text"]}
    for note in words.values():
        share = note["x"] / scenario.end_s
        assert share >= 0.25 or note["xanchor"] == "left"
        assert share <= 0.75 or note["xanchor"] == "right"
    apart = (words["start"]["xanchor"], words["end"]["xanchor"]) == ("right", "left")
    assert apart or words["start"]["yshift"] != words["end"]["yshift"]


def test_a_band_of_another_check_is_drawn(record, make_test, nominal):
    """A figure draws what any check gives, by what it limits and not by the check's name."""
    band = Band(
        check="mine", quantity="dc_voltage_v", name="my limit", t_s=(0.0, 1.0), lower=(700, 700), upper=(900, 950)
    )
    line = _named(figure.test_figure(record, make_test(bands=(band,)), nominal), "my limit")
    assert line["x"] == [0.0, 1.0, 1.0, 1.0, 0.0]
    assert line["y"] == [900, 950, None, 700, 700]


def _band(check, quantity, name, begin_s, end_s, **edges):
    lines = {edge: (value, value) for edge, value in edges.items()}
    return Band(check=check, quantity=quantity, name=name, t_s=(begin_s, end_s), **lines)


def test_every_band_is_drawn_and_named_once(record, make_test, nominal):
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
    drawn = figure.test_figure(record, make_test(bands=bands), nominal)
    looks = {}
    for _, _, name, _ in given:
        traces = [trace for trace in drawn["data"] if trace["name"] == name]
        assert [(trace["x"][0], max(trace["x"])) for trace in traces] == list(stretches)
        assert [trace["showlegend"] for trace in traces] == [True, False, False]
        assert len({trace["legendgroup"] for trace in traces}) == 1
        ((axis, dash, colour),) = {(t["yaxis"], t["line"]["dash"], t["line"]["color"]) for t in traces}
        assert looks.setdefault((axis, dash, colour), name) == name
    dashes = [(axis, dash) for axis, dash, _ in looks]
    assert len(dashes) == len(set(dashes))  # told apart without colour, too


@pytest.mark.parametrize("count", [0, 1, 3, 6])
def test_a_legend_does_not_cover_a_title_or_a_panel(record, make_test, nominal, count):
    """However many names it has, it stands above the title of its panel, and under the panel above it."""
    names = [f"limit of the active power, number {k}" for k in range(count)]
    bands = tuple(_band("mine", "active_power_kw", name, 0.4, 0.6, lower=100.0) for name in names)
    layout = figure.test_figure(record, make_test(bands=bands), nominal)["layout"]
    margins = layout["margin"]
    plot_px = layout["height"] - margins["t"] - margins["b"]
    above, panel = layout["yaxis3"]["domain"][0] * plot_px, layout["yaxis4"]["domain"][1] * plot_px
    room, under = above - layout["legend4"]["y"] * plot_px, layout["legend4"]["y"] * plot_px - panel
    assert under >= (15 if count > 1 else -0.01)  # a title is 15 px high
    in_a_row = 606 // (45 + 6 * max(map(len, names), default=1))
    rows = -(-(count + 2) // in_a_row) if count > 1 else 1
    assert room >= 15 * rows - 4
    assert layout["yaxis5"]["domain"][0] == 0
    assert layout["yaxis"]["domain"][1] == 1
