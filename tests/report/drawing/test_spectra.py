"""Harmonics as bars: what was judged, at its order, beside its limit."""

import pytest

from pvlvrt_compliance.report.drawing.spectra import panels
from pvlvrt_compliance.report.language import Texts, languages
from pvlvrt_compliance.results import Spectrum, SpectrumBar
from shown import points


def spectrum(begin_s, fifth, trd=None):
    """Orders 5 and 7, and a total where it is given."""
    bars = [
        SpectrumBar(order=5, phase="a", measured=fifth, limit=4.0),
        SpectrumBar(order=7, phase="b", measured=0.5, limit=2.0),
    ]
    bars += [] if trd is None else [SpectrumBar(name="TRD", phase="c", measured=trd, limit=5.0)]
    return Spectrum(check="harmonics", start_s=begin_s, end_s=begin_s + 0.2, bars=tuple(bars))


def test_every_bar_has_the_height_that_was_judged(make_test):
    """Side by side before and after, each beside the limit of its order; totals beyond the last order, by name."""
    (panel,) = panels(make_test(spectra=(spectrum(0.08, 3.0, 3.1), spectrum(1.5, 1.0, 1.2))))
    before, after = panel.bars
    assert (before.name, after.name) == ("before", "after")
    assert before.heights == (3.0, 0.5, 3.1)
    assert after.heights == (1.0, 0.5, 1.2)
    assert [(a + b) / 2 for a, b in zip(before.at, after.at, strict=True)] == pytest.approx([5, 7, 9])
    assert after.at[0] - before.at[0] == pytest.approx(before.width)
    (limit,) = panel.lines
    x, y = points(limit)
    assert [(a < at < b, level) for a, b, at, level in zip(x[::2], x[1::2], (5, 7, 9), y[::2], strict=True)] == [
        (True, 4.0),
        (True, 2.0),
        (True, 5.0),
    ]
    (spot,) = panel.spots
    assert (spot.x, spot.words.said(Texts())) == (9, "TRD")


@pytest.mark.parametrize(
    ("fifth", "trd", "told"),
    [
        (3.0, None, ("kept_order", "5", "a", "3.000 %", "4.000 %")),
        (4.1, None, ("failed_order", "5", "a", "4.100 %", "4.000 %")),
        (3.0, 4.9, ("kept_total", "TRD", "c", "4.900 %", "5.000 %")),
        (3.0, 5.5, ("failed_total", "TRD", "c", "5.500 %", "5.000 %")),
    ],
)
def test_the_sentence_tells_what_is_nearest_to_its_limit(make_test, fifth, trd, told):
    """With phase and window; one that is beyond its limit first."""
    (panel,) = panels(make_test(spectra=(spectrum(0.08, 1.0), spectrum(1.5, fifth, trd))))
    values = panel.says.values
    found = (panel.says.key.rpartition(".")[2], *(values[name] for name in ("name", "phase", "measured", "limit")))
    assert found == told
    for language in languages():
        assert "1.500 s" in panel.says.said(Texts(language))


def test_no_spectrum_no_panel(make_test):
    """A test in which no harmonics were judged has no bars."""
    assert panels(make_test()) == ()
