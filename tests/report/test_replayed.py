"""What a report says of outputs beside what was expected: words, figures, files."""

import numpy as np
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report.agreement import lines, to_json, verdict
from pvlvrt_compliance.report.drawing.of_replay import panels
from pvlvrt_compliance.report.replayed import Replayed, as_csv, files_of, refuse_unknown
from pvlvrt_compliance.waveforms.agreement import Tolerance, agreement
from pvlvrt_compliance.waveforms.container import Segment

COUNT = 20_000
T_S = 1e-4 * np.arange(COUNT)


def made(off, unit="V", every=1):
    """A wave that is off, where a number stands, and the wave itself."""
    wave = 100 * np.cos(2 * np.pi * 50 * T_S)
    record = Segment(0.0, 1e-4, {"y": wave + off, "z": wave})
    places = np.arange(0, COUNT, every)
    found = agreement("y", unit, T_S, record["y"], places, wave[places], Tolerance(0.01, 0.0))
    return record, {"y": unit, "z": ""}, (found,)


def test_an_output_that_is_outside_is_told_with_its_place():
    """In the table, below it, and in a word."""
    record, _, found = made(np.where(np.arange(COUNT) >= 10_000, 2.0, 0.0) + 0.5 * (np.arange(COUNT) == 12_000))
    said = "\n".join(lines("C", record, found))
    assert "C: 20000 samples of 100 us\n" in said
    assert "y       V     2.5" in said
    assert "y differs first at 1 s (sample 10000): 102 where 100 is expected; 10000 of 20000 samples are out" in said
    assert said.endswith("1 of 1 output outside of the tolerance")
    assert verdict(found[0]) == "largest error 2.5 V at 1.2 s, allowed 1: OUTSIDE, first at 1 s"


def test_a_shift_is_told():
    """With its direction."""
    wave = np.cos(2 * np.pi * 50 * T_S)
    for shift, words in ((1, "but 1 sample late"), (-2, "but 2 samples early")):
        moved = np.roll(wave, shift)
        found = agreement("y", "", T_S, moved, np.arange(10, COUNT - 10), wave[10:-10], Tolerance(1e-6))
        assert words in "\n".join(lines("C", Segment(0, 1e-4, {"y": moved}), (found,)))


def test_plain_data_has_no_number_that_json_lacks():
    """An infinite error is a text."""
    record, _, found = made(np.where(T_S >= 1.0, np.nan, 0.0))
    data = to_json("C", record, found, ("a note",))
    assert (data["outputs"][0]["largest_error"], data["outputs"][0]["first_difference"]["found"]) == ("inf", "nan")
    assert data["notes"] == ["a note"]


@pytest.mark.parametrize("every", [1, 7])
def test_the_figure_keeps_the_worst_sample(every):
    """However long the record is: the error's extreme stands in its panel, at its instant, beside what is allowed."""
    off = np.where(np.arange(COUNT) == 7 * 1751, -3.25, 0.0)
    record, units, found = made(off, every=every)
    beside, error, other = panels(record, units, found)
    assert beside.title.startswith("y: largest error 3.25 V at 1.2257 s, allowed 1: OUTSIDE")
    assert [line.name for line in beside.lines] == ["given", "expected"]
    (run,) = error.lines[0].runs
    k = int(np.argmin(run.y))
    assert (run.y[k], run.x.first + run.x.step * run.x.numbers[k]) == (-3.25, pytest.approx(1.2257))
    assert [line.runs[0].y for line in error.lines[1:]] == [(1.0, 1.0), (-1.0, -1.0)]
    assert (other.title, other.y.label) == ("z: nothing is expected", "")
    assert sum(len(run.y) for panel in (beside, error, other) for line in panel.lines for run in line.runs) < 30_000


def test_what_is_no_number_is_a_gap():
    """And a column of nothing else draws nothing."""
    record, units, found = made(np.where((T_S > 0.5) & (T_S < 0.6), np.nan, 0.0))
    assert len(panels(record, units, found)) == 3
    nothing = Segment(0.0, 1e-4, {"y": np.full(COUNT, np.nan)})
    (panel,) = panels(nothing, {"y": ""}, ())
    assert panel.lines[0].runs == ()


def test_files_by_their_endings(tmp_path):
    """Others are refused before anything is run."""
    record, units, found = made(0.0)
    of = Replayed("<C>", record, units, found)
    files = files_of([str(tmp_path / "a.csv"), str(tmp_path / "b.HTML")], of)
    assert [content[:9] for content in files.values()] == [b"t_s,y,z\n0", b"<!doctype"]
    assert as_csv(of).encode() == files[tmp_path / "a.csv"]
    assert b"<h1>Replay: &lt;C&gt;</h1>" in files[tmp_path / "b.HTML"]
    with pytest.raises(UsageError, match=r"--output a\.svg: the name must end in \.csv or \.html"):
        refuse_unknown(["a.csv", "a.svg"], "--output")
