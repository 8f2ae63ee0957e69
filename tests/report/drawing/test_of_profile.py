"""What is drawn of a profile, against the curves that judge."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report.drawing.model import outline
from pvlvrt_compliance.report.drawing.of_profile import panels

MARK = 'confidence = "chosen", source = "s"'
HEAD = 'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["iec61400-21"]\n'

REGIONS = """
[requirements.ride_through.regions]
low_quantity = "lowest_phase"
high_quantity = "highest_phase"
confidence = "code"
source = "s"
rows = [
  { voltage_pu = [0, 0.5], mode = "must_trip", respond_s = 0.16 },
  { voltage_pu = [0.5, 0.88], mode = "mandatory", ride_s = { at_pu = 0.5, s = 3, slope_s_per_pu = 8.7 } },
  { voltage_pu = [0.88, 1.1], mode = "continuous" },
  { voltage_pu = [1.1, 9], mode = "may_trip" },
]
"""

CURRENT = """
[requirements.reactive_current]
clause = "c"
source = "s"
""" + "".join(
    f"{key} = {{ value = {value}, {MARK} }}\n"
    for key, value in {
        "k": 2,
        "dead_band_pu": 0.1,
        "dead_band_mode": '"MODE"',
        "reference": '"nominal"',
        "tolerance_plus_pu": 0.2,
        "tolerance_minus_pu": 0.1,
        "limit_pu": 1.0,
        "blocking_allowed_below_pu": 0.2,
    }.items()
)


@pytest.fixture
def panels_of(tmp_path):
    """Panels of a profile with some more text: ``panels_of(text, scale=None)``."""

    def make(text, scale=None):
        (tmp_path / "mine.toml").write_text(HEAD + text, "utf-8")
        return {panel.title: panel for panel in panels(load_profile(str(tmp_path / "mine.toml")), scale)}

    return make


@pytest.mark.parametrize("scale", ["linear", "log"])
@pytest.mark.parametrize("interpolation", ["linear", "step"])
def test_the_envelope_is_drawn_as_it_judges(panels_of, scale, interpolation):
    """Between any two drawn points the line is on the envelope, whatever the axis; a step stands upright."""
    text = f'[requirements.ride_through.envelope]\ninterpolation = "{interpolation}"\n'
    panel = panels_of(text, scale)["Ride-through"]
    envelope = load_profile("iec61400-21").envelope.model_copy(update={"interpolation": interpolation})
    t, level = map(np.array, panel.lines[0].runs[0])
    if scale == "log":
        t = np.log(t)
    middle, level = (t[1:] + t[:-1]) / 2, (level[1:] + level[:-1]) / 2
    rises = np.diff(t) > 0
    expected = envelope.voltage_at(np.exp(middle) if scale == "log" else middle)
    assert np.abs(level - expected)[rises].max() < (0.003 if scale == "log" else 1e-12)


def test_the_axis_of_time_fits_the_times(panels_of):
    """Linear for times of one order, logarithmic for times far apart; asked for, either."""
    assert panels_of("")["Ride-through"].x.scale == "linear"
    far = "[requirements.ride_through.envelope]\npoints = [[0, 0], [0.15, 0], [1800, 0.9]]\n"
    assert panels_of(far)["Ride-through"].x.scale == "log"
    assert panels_of(far, "linear")["Ride-through"].x.scale == "linear"


def test_regions_reach_as_far_as_their_times(panels_of):
    """To the end of riding through or of responding; a time by formula slants; without a time to the figure's end."""
    panel = panels_of(REGIONS, "linear")["Ride-through"]
    corners = {area.name.partition(",")[0]: outline(area.strips[0]) for area in panel.areas}
    ends = {name: (points[1], points[2]) for name, points in corners.items()}
    last = panel.x.span[1]
    assert ends["must trip"] == ((0.16, 0), (0.16, 0.5))
    assert ends["mandatory"][0] == (3, 0.5)
    assert ends["mandatory"][1] == (pytest.approx(3 + 8.7 * 0.38), 0.88)
    assert ends["continuous"] == ((last, 0.88), (last, 1.1))
    assert len({area.colour for area in panel.areas}) == 4


@pytest.mark.parametrize(
    ("mode", "at_20_percent"), [("none", 0.4), ("shift", 0.2), ("step", 0.4)], ids=["none", "shift", "step"]
)
def test_additional_current(panels_of, mode, at_20_percent):
    """K times what the dead band leaves, up to the limit; the band is the tolerances around it."""
    panel = panels_of(CURRENT.replace("MODE", mode))["Additional reactive current"]
    u, current = map(np.array, panel.lines[0].runs[0])
    assert np.interp(-0.2, u, current) == pytest.approx(at_20_percent, abs=1e-5)
    assert np.interp(-1.0, u, current) == 1.0
    assert np.interp(-0.05, u, current) == pytest.approx(0.1 if mode == "none" else 0.0)
    levels = {level for x, level in outline(panel.areas[0].strips[0]) if math.isclose(x, -1.0)}
    assert levels == {1.2, 0.9}


def test_zero_is_on_the_axis(panels_of):
    """The height of a line can be read as such."""
    for panel in panels_of(CURRENT.replace("MODE", "step")).values():
        low, high = panel.y.span
        assert low < 0 < high


def test_lines_and_areas_are_as_sure_as_their_weakest_part(panels_of):
    """A line bears the weakest mark of its points, an area that of its row."""
    points = "[requirements.ride_through.envelope]\npoints = [[0, 0], { t_s = 1, u_pu = 0.8, MARK }]\n"
    own = 'confidence = "memory-low", source = "s"'
    regions = REGIONS.replace('mode = "may_trip" }', f'mode = "may_trip", {own} }}')
    panel = panels_of(points.replace("MARK", own) + regions)["Ride-through"]
    assert [line.name for line in panel.lines] == ["stay connected above (positive sequence) [memory-low]"]
    assert [area.name.rpartition(" ")[2] for area in panel.areas] == ["[code]", "[code]", "[code]", "[memory-low]"]
