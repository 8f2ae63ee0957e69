import numpy as np
import pytest

from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.csv import write_csv


@pytest.fixture
def record() -> Waveforms:
    """Two segments of random values over many decades, more rows than one block."""
    values = np.random.default_rng(6).normal(size=(2, 2500)) * 10.0 ** np.linspace(-12, 12, 2500)
    first = Segment(-0.1, 40.9568e-6, {"u_a_v": values[0], "connected": np.ones(2500)})
    second = Segment(10.0, 1e-3, {"u_a_v": values[1], "connected": np.zeros(2500)})
    return Waveforms((first, second))


def test_numpy_reads_back_what_was_written(record, tmp_path):
    """Every value comes back to 9 significant digits and every time to 1e-9 s."""
    path = tmp_path / "record.csv"
    write_csv(record, path)
    table = np.genfromtxt(path, delimiter=",", names=True)
    assert table.dtype.names == ("t_s", "u_a_v", "connected")
    for name in ("u_a_v", "connected"):
        expected = np.concatenate([segment[name] for segment in record])
        assert np.allclose(table[name], expected, rtol=1e-8, atol=0)
    assert np.abs(table["t_s"] - np.concatenate([segment.t_s for segment in record])).max() <= 0.51e-9


def test_the_same_record_gives_the_same_bytes(record, tmp_path):
    """Two files of one record are equal, with line feeds only."""
    for name in ("a.csv", "b.csv"):
        write_csv(record, tmp_path / name)
    text = (tmp_path / "a.csv").read_bytes()
    assert text == (tmp_path / "b.csv").read_bytes()
    assert b"\r" not in text
    assert text.count(b"\n") == 5001
