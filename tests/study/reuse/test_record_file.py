"""One record as a file."""

import numpy as np
import pytest

from pvlvrt_compliance.study.reuse.record_file import DamagedError, Kept, read_record, size_of, write_record
from pvlvrt_compliance.waveforms import Segment, Waveforms

KEY = "a" * 64


def bits_of(waveforms):
    """All that a record holds, every number to the bit."""
    parts = (*waveforms.settling, *waveforms.segments)
    samples = [
        (name, x.tobytes(), x.dtype, x.flags["C_CONTIGUOUS"]) for part in parts for name, x in part.channels.items()
    ]
    times = [(part.t0_s.hex(), part.dt_s.hex()) for part in parts]
    return len(waveforms.settling), times, waveforms.tripped_at_s, samples


@pytest.fixture
def written(tmp_path, made):
    """A file of a record."""
    file = tmp_path / "one.record"
    write_record(file, KEY, made())
    return file


def test_a_record_comes_back_to_the_bit(tmp_path):
    """So do numbers that are none, both zeros, the smallest numbers, a single sample, notes, and no trip."""
    odd = np.array([np.nan, -np.nan, np.inf, -0.0, 0.0, 5e-324, 0.1])
    odd[1:2].view(np.int64)[:] += 7  # a payload
    channels = {"odd": odd, "same": np.full(7, -np.nan), "zeros": np.array([0.0, 0, 0, -0.0, 0, 0, 0])}
    last = Segment(1.0, 0.5, {name: x[:1] for name, x in channels.items()})
    kept = Kept(Waveforms((Segment(0.0, 0.1, channels), last)), ("ein Hinweis, é", "another\nnote"))
    write_record(tmp_path / "odd.record", KEY, kept)
    found = read_record(tmp_path / "odd.record", KEY)
    assert bits_of(found.waveforms) == bits_of(kept.waveforms)
    assert found.notes == kept.notes


def test_a_channel_that_stays_the_same_takes_one_sample(tmp_path, made):
    """Of the two channels of three segments one changes."""
    write_record(tmp_path / "file", KEY, made(rows=10_000))
    size = (tmp_path / "file").stat().st_size
    assert size_of(made(rows=10_000)) == 6 * 8 * 10_000
    assert 3 * 8 * 10_000 < size < 3 * 8 * 10_000 + 2000


@pytest.mark.parametrize("at", ["head", "table", "first sample", "last sample"])
def test_any_byte_that_changes_is_noticed(written, at):
    """Wherever it is: none of it is taken then."""
    content = bytearray(written.read_bytes())
    content[{"head": 3, "table": 60, "first sample": -3 * 100 * 8, "last sample": -1}[at]] ^= 1
    written.write_bytes(content)
    with pytest.raises(DamagedError):
        read_record(written, KEY)


@pytest.mark.parametrize("length", [0, 10, 40, 500, -8, -1])
def test_a_file_that_ends_too_early_is_noticed(written, length):
    """At its beginning, in its table, in its samples."""
    written.write_bytes(written.read_bytes()[:length])
    with pytest.raises(DamagedError):
        read_record(written, KEY)


def test_a_file_that_goes_on_is_noticed(written):
    """It is not what was written."""
    written.write_bytes(written.read_bytes() + b"\0")
    with pytest.raises(DamagedError):
        read_record(written, KEY)


def test_a_file_under_the_name_of_another_is_none(written):
    """The key stands inside, too."""
    with pytest.raises(DamagedError, match="another record's"):
        read_record(written, "b" * 64)


def test_no_part_is_left_where_a_file_cannot_be_written(tmp_path, made, monkeypatch):
    """What was begun is removed, and what was there stays."""
    write_record(tmp_path / "file", KEY, made())

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pvlvrt_compliance.study.reuse.record_file._write", full)
    with pytest.raises(OSError, match="No space"):
        write_record(tmp_path / "file", KEY, made(1.0))
    assert [file.name for file in tmp_path.iterdir()] == ["file"]
    assert bits_of(read_record(tmp_path / "file", KEY).waveforms) == bits_of(made().waveforms)
