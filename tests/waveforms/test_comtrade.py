from datetime import UTC, datetime, timedelta, timezone

import comtrade
import numpy as np
import pytest

from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.comtrade import EPOCH, write_comtrade

DT_S = 40.9568e-6
NAMES = ("u_a_v", "u_b_v", "u_c_v", "i_a_a", "v_dc_v", "i_pv_a", "irradiance_w_m2", "q_ref_var", "v_fault_pu")


def segment(t0_s, dt_s, n, seed=0, names=NAMES):
    """Random channels and two status channels."""
    noise = np.random.default_rng(seed)
    channels = {name: noise.normal(scale=300, size=n) for name in names}
    channels["connected"] = (noise.random(n) < 0.5).astype(float)
    channels["fault_signal"] = (noise.random(n) < 0.5).astype(float)
    return Segment(t0_s, dt_s, channels)


def write(waveforms, stem, **options):
    """Write with the defaults of these tests."""
    return write_comtrade(
        waveforms, stem, **({"station": "PV", "device": "inverter", "frequency_hz": 50, "start": None} | options)
    )


def read(stem):
    """Read with the package that others use."""
    found = comtrade.Comtrade(ignore_warnings=True, use_double_precision=True, use_numpy_arrays=True)
    found.load(str(stem.with_suffix(".cfg")), str(stem.with_suffix(".dat")))
    return found


def assert_same(found, waveforms):
    """Every channel to float32, status channels exactly, time to 1e-9 s."""
    assert list(found.analog_channel_ids) + list(found.status_channel_ids) == list(waveforms.names)
    for name, values in zip(found.analog_channel_ids, found.analog, strict=True):
        expected = np.concatenate([s[name] for s in waveforms]).astype(np.float32)
        assert np.array_equal(np.asarray(values), expected)
    for name, values in zip(found.status_channel_ids, found.status, strict=True):
        assert np.array_equal(np.asarray(values), np.concatenate([s[name] for s in waveforms]))
    expected_t = np.concatenate([s.t_s for s in waveforms]) - waveforms.t0_s
    assert np.abs(np.asarray(found.time) - expected_t).max() < 1e-9


def test_another_program_reads_the_record_back(tmp_path):
    """The PyPI package comtrade finds every channel, its unit and phase, and the time."""
    waveforms = Waveforms((segment(0.0, DT_S, 3000),))
    paths = write(waveforms, tmp_path / "VD3-full-1.5")
    assert [path.name for path in paths] == ["VD3-full-1.5.cfg", "VD3-full-1.5.dat"]
    found = comtrade.Comtrade(ignore_warnings=True, use_double_precision=True, use_numpy_arrays=True)
    found.load(*(str(path) for path in paths))
    assert_same(found, waveforms)
    assert (found.rev_year, found.ft, found.station_name, found.rec_dev_id) == ("2013", "FLOAT32", "PV", "inverter")
    assert found.frequency == 50
    by_name = {channel.name: channel for channel in found.cfg.analog_channels}
    assert [by_name[n].uu for n in NAMES] == ["V", "V", "V", "A", "V", "A", "W/m2", "var", "pu"]
    assert [by_name[n].ph for n in NAMES] == ["A", "B", "C", "A", "", "", "", "", ""]


def test_time_holds_for_a_long_record(tmp_path):
    """After 100 s the time told by the sampling rate is right to 1e-9 s."""
    n = int(100 / DT_S)
    waveforms = Waveforms((Segment(0.0, DT_S, {"v_dc_v": np.zeros(n)}),))
    write(waveforms, tmp_path / "long")
    rate, last = read_rates(tmp_path / "long.cfg")[-1]
    assert last == n
    assert (n - 1) / rate == pytest.approx(waveforms.end_s, abs=1e-9)


def read_rates(path):
    """Sampling rates of a configuration file, with the last sample of each."""
    lines = path.read_text(encoding="utf-8").splitlines()
    channels = int(lines[1].split(",")[0])
    count = int(lines[3 + channels])
    rates = [line.split(",") for line in lines[4 + channels : 4 + channels + count]]
    return [(float(rate), int(last)) for rate, last in rates]


def test_segments_with_steps_of_their_own(tmp_path):
    """A record with three steps, one segment one of its steps later, one after a pause, keeps its time."""
    first = segment(-0.3, DT_S, 500)
    second = segment(first.end_s + 10 * DT_S, 10 * DT_S, 70, 1)
    third = segment(second.end_s + 0.5, DT_S, 400, 2)
    fourth = segment(third.end_s + DT_S, 10 * DT_S, 50, 3)
    waveforms = Waveforms((first, second, third, fourth))
    write(waveforms, tmp_path / "steps")
    assert_same(read(tmp_path / "steps"), waveforms)


def test_segments_on_one_grid_have_a_rate_each(tmp_path):
    """Of fine and thin stretches on one grid, every step goes with a rate of one segment: none more is needed."""
    cuts = ((0, 8000, 1), (8000, 16000, 8), (16000, 17000, 1))
    waveforms = Waveforms(tuple(segment(i * DT_S, n * DT_S, len(range(i, j, n)), n) for i, j, n in cuts))
    write(waveforms, tmp_path / "thin")
    assert_same(read(tmp_path / "thin"), waveforms)
    rates = read_rates(tmp_path / "thin.cfg")
    assert [rate for rate, _ in rates] == pytest.approx([1 / DT_S, 1 / (8 * DT_S), 1 / DT_S])
    assert [last for _, last in rates] == [8001, 9001, 10000]


@pytest.mark.parametrize("n", [1, 2])
def test_segments_of_few_samples(tmp_path, n):
    """Segments of a sample or two keep their time too."""
    parts = tuple(segment(k * 1.0, 1e-3 * (k + 1), n, k) for k in range(4))
    write(Waveforms(parts), tmp_path / "few")
    assert_same(read(tmp_path / "few"), Waveforms(parts))


def test_time_stamps_are_microseconds(tmp_path):
    """The time stamp of a sample is its time after the first in whole microseconds."""
    waveforms = Waveforms((Segment(0.2, DT_S, {"v_dc_v": np.arange(1000.0)}),))
    _, dat = write(waveforms, tmp_path / "stamps")
    rows = np.fromfile(dat, dtype=[("n", "<u4"), ("t", "<u4"), ("v", "<f4")])
    assert np.array_equal(rows["n"], np.arange(1, 1001))
    assert np.abs(rows["t"] - DT_S * 1e6 * np.arange(1000)).max() <= 0.5 + 1e-6


def test_time_stamps_of_more_than_an_hour(tmp_path):
    """Where microseconds no longer fit 32 bits, the stamps count tens of them and the file says so."""
    waveforms = Waveforms((Segment(0.0, 100.0, {"v_dc_v": np.zeros(60)}),))
    _, dat = write(waveforms, tmp_path / "hours")
    rows = np.fromfile(dat, dtype=[("n", "<u4"), ("t", "<u4"), ("v", "<f4")])
    assert read(tmp_path / "hours").cfg.timemult == 10
    assert rows["t"][-1] == 59 * 100.0 * 1e5


def test_more_than_sixteen_status_channels_are_not_needed_but_none_is_allowed(tmp_path):
    """A record with analogue channels only, or status channels only, is written and read."""
    for name, channels in {
        "analog": {"v_dc_v": np.arange(10.0)},
        "status": {"connected": np.array([0.0, 1.0, 1.0, 0.0])},
    }.items():
        waveforms = Waveforms((Segment(0.0, 1e-3, channels),))
        write(waveforms, tmp_path / name)
        assert_same(read(tmp_path / name), waveforms)


def test_the_date_is_that_of_time_zero(tmp_path):
    """The first sample is stamped start + t0 in UTC, the trigger where it is asked for."""
    start = datetime(2024, 5, 6, 12, 0, 0, tzinfo=timezone(timedelta(hours=2)))
    write(Waveforms((segment(-0.25, DT_S, 100),)), tmp_path / "dated", start=start, trigger_s=0.3)
    found = read(tmp_path / "dated")
    assert found.start_timestamp == datetime(2024, 5, 6, 9, 59, 59, 750000)
    assert found.trigger_timestamp == datetime(2024, 5, 6, 10, 0, 0, 300000)


def test_the_same_record_gives_the_same_bytes(tmp_path):
    """Without a date, two files of one record are equal and carry the fixed one."""
    waveforms = Waveforms((segment(0.0, DT_S, 200),))
    first, second = (write(waveforms, tmp_path / folder / "x") for folder in made(tmp_path, "a", "b"))
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in second]
    assert read(first[0].with_suffix("")).start_timestamp.replace(tzinfo=UTC) == EPOCH


def made(folder, *names):
    """Names of folders that exist now."""
    for name in names:
        (folder / name).mkdir()
    return names


def test_names_cannot_break_the_file(tmp_path):
    """Commas and line breaks in names of station and device become spaces."""
    write(Waveforms((segment(0.0, DT_S, 20),)), tmp_path / "x", station="Plant, 5\nnorth", device="é" * 100)
    found = read(tmp_path / "x")
    assert (found.station_name, found.rec_dev_id) == ("Plant  5 north", "é" * 64)
