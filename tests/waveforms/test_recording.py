import numpy as np
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.csv import write_csv
from pvlvrt_compliance.waveforms.recording import read_recording, read_waveforms

DT_S = 40.9568e-6
WHOLE = 100 * np.cos(2 * np.pi * 50 * DT_S * np.arange(24000))


def stretch(first, end, step, offset=0.0):
    """Samples of the whole at a step of its own."""
    return Segment((first + offset) * DT_S, step * DT_S, {"u_a_v": WHOLE[first:end:step]})


def written(waveforms, folder, form):
    """Path of the record in one of the forms."""
    if form == "csv":
        write_csv(waveforms, folder / "record.csv")
        return folder / "record.csv"
    return write_comtrade(waveforms, folder / "record", station="", device="", frequency_hz=50, start=None)[0]


@pytest.fixture
def thin():
    """A record of three segments on one grid."""
    return Waveforms((stretch(0, 8000, 1), stretch(8000, 16000, 8), stretch(16000, 24000, 1)))


@pytest.mark.parametrize("form", ["csv", "comtrade"])
def test_segments_are_read_back(tmp_path, thin, form):
    """Every segment comes back with its own start and step."""
    found = read_waveforms(written(thin, tmp_path, form), ["u_a_v"])
    assert len(found.segments) == 3
    for read, was in zip(found, thin, strict=True):
        assert (read.t0_s, read.dt_s) == (pytest.approx(was.t0_s, abs=1e-9), pytest.approx(was.dt_s, rel=1e-6))
        assert np.allclose(read["u_a_v"], was["u_a_v"], rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("form", ["csv", "comtrade"])
def test_a_recording_is_on_one_grid(tmp_path, thin, form):
    """What is played back has one step, the longest of the record, over all of it."""
    found = read_recording(written(thin, tmp_path, form), ["u_a_v"])
    assert found.dt_s == pytest.approx(8 * DT_S, rel=1e-6)
    assert np.allclose(found["u_a_v"], WHOLE[::8], rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize(
    "second",
    [
        stretch(8001, 16000, 1),
        stretch(8040, 16000, 1),
        stretch(8000, 16000, 8, offset=11),
        stretch(8000, 16000, 8, 0.4),
    ],
)
def test_a_recording_with_a_pause_is_refused(tmp_path, second):
    """A missing sample, a pause, and grids that do not fit."""
    path = written(Waveforms((stretch(0, 8000, 1), second)), tmp_path, "csv")
    with pytest.raises(UsageError, match="not evenly spaced"):
        read_recording(path, ["u_a_v"])


@pytest.mark.parametrize("form", ["csv", "comtrade"])
def test_a_whole_record_is_read_back(tmp_path, form):
    """Without names of channels all come back, those that hold 0 or 1 too."""
    closed = (np.arange(1000) < 500).astype(float)
    was = Waveforms(
        (Segment(0.0, DT_S, {"u_a_v": WHOLE[:1000], "connected": closed, "trip_cause": 3.0 * (1 - closed)}),)
    )
    (read,) = read_waveforms(written(was, tmp_path, form))
    assert set(read.channels) == {"u_a_v", "connected", "trip_cause"}
    assert np.array_equal(read["connected"], closed)
    assert np.allclose(read["trip_cause"], 3.0 * (1 - closed))
