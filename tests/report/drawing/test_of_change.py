"""The record of a new run over that of an old one."""

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.evidence.collect import collect_without_profile
from pvlvrt_compliance.report.drawing import svg
from pvlvrt_compliance.report.drawing.model import values
from pvlvrt_compliance.report.drawing.of_change import CYCLES_AFTER, CYCLES_BEFORE, drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import Status

AT_S = 0.371  # of the current limit's verdict


@pytest.fixture(scope="module")
def pair(make_record, make_test, scenario, nominal):
    """An old and a new run of one sag, the new one tripped at 0.42 s: evidence and result each."""

    def seen(opens_s):
        record = make_record(scenario, opens_s)
        asked = disturbance_asked(scenario, make_test().disturbance.normal)
        test = make_test()
        return collect_without_profile(record, nominal, asked, 5e5, test.measurements), test

    return seen(None), seen(0.42)


def drawn(pair, check, **changed):
    """The drawing of a check, of which both runs say the same but for what is ``changed`` in the new one."""
    old, new = pair
    (verdict,) = [one for one in old[1].checks if one.check == check]
    return drawing((verdict, verdict.model_copy(update=changed)), old, new)


def test_what_was_judged_is_drawn_first(pair):
    """The panel with the limits of the check comes before what stands beside it, three in all."""
    keys = [panel.key for panel in drawn(pair, "current_limit").panels]
    assert (keys[0], len(keys)) == ("currents", 3)
    assert drawn(pair, "reactive_support").panels[0].key == "reactive_power"


def test_the_window_lies_about_the_worst_instant(pair):
    """Some cycles before and after it; where no verdict says when, the whole record."""
    found = drawn(pair, "current_limit")
    assert found.span == pytest.approx((AT_S - CYCLES_BEFORE / 50, AT_S + CYCLES_AFTER / 50), abs=1e-6)
    assert found.panels[0].x.span == found.span
    for panel in found.panels:
        for line in panel.lines:
            for run in line.runs:
                x = np.asarray(values(run.x))
                assert found.span[0] - 1e-4 <= x.min() <= x.max() <= found.span[1] + 1e-4
    evidence = pair[1][0]
    whole = drawn(pair, "dc_ripple").span
    assert whole == (evidence.waveforms.t0_s, evidence.waveforms.end_s)


def test_a_worst_instant_at_an_end_leaves_the_window_as_long(pair):
    """The window moves into the record."""
    end_s = pair[1][0].waveforms.end_s
    span = drawn(pair, "current_limit", at_s=end_s).span
    assert span[1] == pytest.approx(end_s, abs=1e-6)
    assert span[1] - span[0] == pytest.approx((CYCLES_BEFORE + CYCLES_AFTER) / 50, abs=1e-6)


def test_both_runs_have_each_curve_and_are_told_apart_without_colour(pair):
    """Dotted and solid, and by their names in either language; no limit is dotted."""
    panel = drawn(pair, "current_limit").panels[0]
    names = {line.name: line.dash for line in panel.lines}
    old = {name.removesuffix(" (old)") for name, dash in names.items() if name.endswith(" (old)") and dash == "dot"}
    new = {name.removesuffix(" (new)") for name, dash in names.items() if name.endswith(" (new)") and dash == "solid"}
    assert old == new >= {"i<sub>a</sub>", "largest fundamental"}
    limits = {name: dash for name, dash in names.items() if not name.endswith((" (old)", " (new)"))}
    assert set(limits) == {"limit, fundamental", "limit, peak"}
    assert "dot" not in limits.values()
    for language, words in (("en", ("largest fundamental, old", ", new")), ("es", (", anterior", ", nuevo"))):
        texts = Texts(language)
        picture = svg.figure(panel, drawn(pair, "current_limit"), texts)
        assert all(word in picture for word in words)


def test_each_curve_is_that_of_its_run(pair):
    """After the trip of the new run its current is zero, and that of the old one is not."""
    panel = drawn(pair, "current_limit", at_s=0.45).panels[0]
    peaks = {}
    for line in panel.lines:
        x = np.concatenate([np.asarray(values(run.x)) for run in line.runs])
        y = np.concatenate([np.asarray(run.y) for run in line.runs])
        peaks[line.name] = np.abs(y[x > 0.45]).max()
    assert peaks["i<sub>a</sub> (new)"] == pytest.approx(0, abs=1e-9)
    assert peaks["i<sub>a</sub> (old)"] > 0.9


def test_limits_stand_only_in_the_panel_of_their_check(pair):
    """The envelope of another check says nothing of this one; words say which run the limits are of."""
    first, *others = drawn(pair, "current_limit").panels
    assert first.says.key == "comparison.overlay.limits"
    assert {panel.says.key for panel in others} == {"comparison.overlay.curves"}
    assert not [area for panel in others for area in panel.areas]


def test_the_worst_instants_are_pointed_out(pair):
    """A spot for each run within the window, and words above it that name the instant."""
    found = drawn(pair, "current_limit", at_s=AT_S + 0.02, status=Status.FAIL)
    spots = {spot.words.key: spot for spot in found.panels[0].spots}
    assert {key: round(spot.x, 3) for key, spot in spots.items()} == {
        "comparison.overlay.old": 0.371,
        "comparison.overlay.new": 0.391,
    }
    assert spots["comparison.overlay.new"].is_broken
    words = [mark.words.said(Texts()) for mark in found.marks if mark.words]
    assert words == ["new run worst at 0.391 s", "old run worst at 0.371 s"]
