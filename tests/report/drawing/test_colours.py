"""Colours of curves can be seen on both grounds."""

import itertools

import pytest

from pvlvrt_compliance.report.drawing import colours
from pvlvrt_compliance.report.drawing.colours import ON_DARK, PAPER
from pvlvrt_compliance.report.drawing.of_test import _FAINT

CURVES = [colour for colour in ON_DARK if colour not in (colours.SHADE, colours.GRID, PAPER)]
LEAST = 3.0  # WCAG 2.2, 1.4.11: graphical objects


def channels(colour):
    """Red, green and blue of a colour, 0 to 1."""
    return [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]


def luminance(rgb):
    """Relative luminance by WCAG 2.2."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
    return sum(weight * c for weight, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    """Contrast ratio by WCAG 2.2 of red, green and blue each."""
    low, high = sorted(map(luminance, (one, other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("colour", CURVES)
def test_a_curve_is_seen_on_both_grounds(colour):
    """Every colour of a curve, limit or word has a contrast of 3 to 1 to the ground of its theme."""
    assert contrast(channels(colour), channels(PAPER)) >= LEAST
    assert contrast(channels(ON_DARK[colour]), channels(ON_DARK[PAPER])) >= LEAST


@pytest.mark.parametrize("colour", [colours.BLACK, colours.PURPLE])
def test_a_faint_curve_is_seen_too(colour):
    """What lies pale behind what is judged keeps 3 to 1 once it is blended with the ground."""
    for curve, ground in ((colour, PAPER), (ON_DARK[colour], ON_DARK[PAPER])):
        blend = [_FAINT * c + (1 - _FAINT) * g for c, g in zip(channels(curve), channels(ground), strict=True)]
        assert contrast(blend, channels(ground)) >= LEAST


def test_the_phases_differ_by_lightness_too():
    """Printed in grey, or seen by an eye that tells no colours, no two phases look alike."""
    for theme in (lambda colour: colour, ON_DARK.get):
        shades = [luminance(channels(theme(colour))) for colour in colours.PHASES.values()]
        for one, other in itertools.combinations(shades, 2):
            assert (max(one, other) + 0.05) / (min(one, other) + 0.05) > 1.15


def test_every_colour_that_is_used_has_its_variable():
    """Whatever the package draws a test with has a colour for each theme; another stays as it is."""
    used = [*colours.PHASES.values(), *colours.FURTHER, *colours.OF_A_PROFILE]
    used += [colours.BLUE, colours.VERMILION, colours.PURPLE, colours.GREY, colours.BLACK]
    style = colours.style()
    assert all(f"{colours.variable(colour)}:light-dark({colour}," in style for colour in used)
    assert colours.variable("#123456") == ""
