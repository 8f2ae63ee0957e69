"""The page on the shipped grid codes: what it says of a profile beside the verdicts."""

from pvlvrt_compliance.profile import load_profile
from validation.grid_codes import page

PROFILE = """
schema_version = 1
id = "mine"
title = "a profile of a test"
include = ["ieee1547-cat-ii"]
[[tests]]
id = "steady"
expect = "must_trip"
by_s = 0.5
[requirements.ride_through.envelope]
points = [[0, 0.0], { t_s = 1.5, u_pu = 0.8, confidence = "memory", source = "a point" }]
interpolation = "linear"
voltage_quantity = "lowest_phase"
confidence = "code"
source = "a line"
"""


def test_what_tests_demand():
    """Tests that the inverter may leave are named, with what holds for all others."""
    (line, *_) = page.demanded(load_profile("dk-rfg"))
    assert line.startswith("- may trip where the limits let it go: `3ph-0.80-60s`, ")
    assert "`phase-jump-extreme-40`; all other tests are to be ridden through as a whole" in line
    assert page.demanded(load_profile("es-po-12.3")) == []


def test_least_current():
    """How much current is the least, of which, and how sure that is."""
    words = "- least current in mandatory operation: 0.5 of the current before, of the phase with the most (chosen)."
    assert words in page.demanded(load_profile("nerc-prc-029"))


def test_marks_of_rows_and_points(tmp_path):
    """Every row and point with a mark of its own is told, and what a test must do by when."""
    file = tmp_path / "mine.toml"
    file.write_text(PROFILE, encoding="utf-8")
    said = page.demanded(load_profile(str(file)))
    assert "- `ride_through.envelope.points[1]`: memory (a point), a mark of the row's own." in said
    assert "- must trip: `steady` by 0.5 s; all other tests are to be ridden through as a whole." in said
    assert any("of the three phases together (rms) (code)" in line for line in said)
