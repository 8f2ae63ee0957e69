"""COMTRADE of other recorders: the same waveform as of the plain form, or one line that says what is wrong."""

import random
import struct

import numpy as np
import pytest
from comtrade import Comtrade

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.playback import read_voltages
from pvlvrt_compliance.waveforms.recording import read_columns, read_waveforms

NAMES = ["u_a_v", "u_b_v", "u_c_v"]
RATE_HZ, ROWS, PEAK = 1000, 60, 300.0
PHASES = [PEAK * np.cos(2 * np.pi * (50 * np.arange(ROWS) / RATE_HZ - k / 3)) for k in range(3)]
GAIN, OFFSET = 0.015625, -3.5  # exact in binary
STORED = [np.rint((x - OFFSET) / GAIN).astype(int) for x in PHASES]
VOLTS = [GAIN * x + OFFSET for x in STORED]
CLOSED = [int(n >= ROWS // 2) for n in range(ROWS)]


def cfg(
    form="ASCII", *, edition=",1999", unit="V", ratio=",1,1,P", names=NAMES, rates=f"1\n{RATE_HZ},{ROWS}", more="1\n"
):
    """A configuration of three voltages and a status channel."""
    gain, offset = (1.0, 0.0) if form == "FLOAT32" else (GAIN, OFFSET)
    channels = "".join(
        f"{k},{name},,,{unit},{gain!r},{offset!r},0,-32767,32767{ratio}\n" for k, name in enumerate(names, start=1)
    )
    stamp = "01/02/2020,03:04:05.000006"
    return f"Station,Recorder{edition}\n4,3A,1D\n{channels}1,closed,,,0\n50\n{rates}\n{stamp}\n{stamp}\n{form}\n{more}"


def dat(form="ASCII", rows=ROWS, stamps=True):
    """The samples."""
    step_us = 10**6 // RATE_HZ
    if form == "ASCII":
        lines = (
            f"{n + 1},{n * step_us if stamps else ''},{STORED[0][n]},{STORED[1][n]},{STORED[2][n]},{CLOSED[n]}\r\n"
            for n in range(rows)
        )
        return "".join(lines).encode()
    letter, of = {"BINARY": ("h", STORED), "BINARY32": ("i", STORED), "FLOAT32": ("f", VOLTS)}[form]
    return b"".join(
        struct.pack(f"<II3{letter}H", n + 1, n * step_us if stamps else 2**32 - 1, *(x[n] for x in of), CLOSED[n])
        for n in range(rows)
    )


def put(folder, configuration, samples, encoding="utf-8"):
    """Both files; the path of the first."""
    content = configuration if isinstance(configuration, bytes) else configuration.encode(encoding)
    (folder / "fault.cfg").write_bytes(content)
    (folder / "fault.dat").write_bytes(samples)
    return folder / "fault.cfg"


def is_the_recording(samples, names=NAMES, factor=1.0):
    """Whether these are the voltages that were written, to the last bit but one."""
    return samples.dt_s == pytest.approx(1 / RATE_HZ) and all(
        np.allclose(samples[name], factor * VOLTS[k], rtol=1e-12) for k, name in enumerate(names)
    )


@pytest.mark.parametrize("form", ["ASCII", "BINARY", "BINARY32", "FLOAT32", "binary"])
@pytest.mark.parametrize("edition", ["", ",1991", ",1999", ",2013", ",2001"])
def test_each_form_is_the_same_recording(tmp_path, form, edition):
    """Sample for sample, of every edition, and the status channel with it."""
    path = put(tmp_path, cfg(form, edition=edition), dat(form.upper()))
    (found,) = read_waveforms(path)
    assert is_the_recording(found)
    assert found["closed"].tolist() == CLOSED
    assert is_the_recording(read_voltages(path, NAMES, None, 50.0))


@pytest.mark.parametrize("form", ["ASCII", "BINARY", "BINARY32", "FLOAT32"])
def test_both_in_one_file(tmp_path, form):
    """As the edition of 2013 has it, with or without the pieces in between."""
    for others in ("", "--- file type: INF ---\r\n\r\n--- file type: HDR ---\r\nabout it\r\n"):
        length = "" if form == "ASCII" else f": {len(dat(form))}"
        head = f"--- file type: CFG ---\r\n{cfg(form, edition=',2013')}\r\n{others}"
        head += f"--- file type: DAT {form}{length} ---\r\n"
        (tmp_path / "fault.cff").write_bytes(head.encode() + dat(form))
        assert is_the_recording(read_voltages(tmp_path / "fault.cff", NAMES, None, 50.0))
    (tmp_path / "fault.cff").write_bytes(dat(form))
    with pytest.raises(UsageError, match="no lines that say where configuration"):
        read_voltages(tmp_path / "fault.cff", NAMES, None, 50.0)


@pytest.mark.parametrize(
    ("unit", "ratio", "factor"),
    [
        ("V", ",400,100,S", 4.0),
        ("V", ",400,100,s", 4.0),
        ("V", ",400,100,P", 1.0),
        ("kV", ",1,1,P", 1e3),
        ("KV", ",0.4,0.1,S", 4e3),
        ("mV", ",1,1,P", 1e-3),
        ("MV", ",1,1,P", 1e6),
        (" V ", "", 1.0),
        ("Volts", "", 1.0),
        ("", ",1,1,P", 1.0),
    ],
)
def test_values_are_volts_of_the_primary_side(tmp_path, unit, ratio, factor):
    """By the unit and by the ratio that the configuration has; a scale is on top of it."""
    path = put(tmp_path, cfg("BINARY", unit=unit, ratio=ratio), dat("BINARY"))
    (found,) = read_waveforms(path)
    assert is_the_recording(found, factor=factor)
    assert is_the_recording(read_voltages(path, NAMES, 1 / factor, 50.0))


def test_of_per_unit_the_base_is_needed(tmp_path):
    """A configuration does not have it."""
    path = put(tmp_path, cfg(unit="p.u."), dat())
    with pytest.raises(UsageError, match="'u_a_v' is per unit, of a base that the file does not say: give scale"):
        read_voltages(path, NAMES, None, 50.0)
    with pytest.raises(UsageError, match="'u_a_v' is per unit, of a base that the file does not say; it is needed"):
        read_waveforms(path)
    with pytest.raises(UsageError, match="'u_a_v' is not in V by its unit"):
        read_waveforms(put(tmp_path, cfg(unit="kA"), dat()))
    put(tmp_path, cfg(unit="p.u."), dat())
    assert is_the_recording(read_voltages(path, NAMES, 2.0, 50.0), factor=2.0)


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8", "utf-8-sig"])
def test_names_in_either_encoding(tmp_path, encoding):
    """Blanks around them are none of theirs."""
    names = ["Außenleiter 1", "Phase ç", "Größe"]
    path = put(tmp_path, cfg(names=[f" {name} " for name in names]), dat(), encoding)
    assert is_the_recording(read_voltages(path, names, None, 50.0), names)


@pytest.mark.parametrize("form", ["ASCII", "BINARY"])
def test_the_time_is_told_by_rates_or_by_stamps(tmp_path, form):
    """By the rates where there are some; without, by the stamps, in their factor."""
    without = cfg(form, rates=f"0\n0,{ROWS}", more="2.5\n")
    t, _ = read_columns(put(tmp_path, without, dat(form)))
    assert np.allclose(t, 2.5 * np.arange(ROWS) / RATE_HZ, rtol=1e-12)
    t, _ = read_columns(put(tmp_path, cfg(form), dat(form, stamps=False)))
    assert np.allclose(t, np.arange(ROWS) / RATE_HZ, rtol=1e-12)
    with pytest.raises(UsageError, match="sample 1 has neither a sampling rate nor a time stamp"):
        read_columns(put(tmp_path, without, dat(form, stamps=False)))


@pytest.mark.parametrize("form", ["ASCII", "BINARY", "BINARY32", "FLOAT32"])
def test_another_reader_finds_the_same(tmp_path, form):
    """The library of that name has the same times and numbers; it does not know of the primary side."""
    rates = f"3\n{RATE_HZ},20\n{2 * RATE_HZ},40\n{RATE_HZ / 3!r},{ROWS}"
    path = put(tmp_path, cfg(form, rates=rates), dat(form))
    other = Comtrade(use_double_precision=True)
    other.load(str(path))
    t, columns = read_columns(path)
    assert np.allclose(t, other.time, rtol=0, atol=1e-12)
    for name, samples in zip(columns, [*other.analog, *other.status], strict=True):
        assert np.allclose(columns[name].samples, samples, rtol=0, atol=1e-12)


MISSING = [
    (",1999", "ASCII", b"\n31,30000,99999,", "no finite number at its sample 31"),
    (",1999", "ASCII", b"\n31,30000,,", "no finite number at its sample 31"),
    (",1999", "BINARY", struct.pack("<IIh", 31, 30000, -(2**15)), "no finite number at its sample 31"),
    ("", "BINARY", struct.pack("<IIh", 31, 30000, -1), "no finite number at its sample 31"),
    (",2013", "BINARY32", struct.pack("<IIi", 31, 30000, -(2**31)), "no finite number at its sample 31"),
    (",2013", "FLOAT32", struct.pack("<IIf", 31, 30000, np.nan), "no finite number at its sample 31"),
    (",2013", "FLOAT32", struct.pack("<III", 31, 30000, 0x7FA00001), "no finite number at its sample 31"),
]


@pytest.mark.parametrize(("edition", "form", "row", "says"), MISSING)
def test_a_missing_value_is_not_played_back(tmp_path, edition, form, row, says):
    """As each form of each edition says it."""
    content = dat(form)
    if form == "ASCII":
        begin = content.index(b"\n31,")
        end = content.index(b",", begin + len(b"\n31,30000,")) + 1
    else:
        begin = 30 * (len(content) // ROWS)
        end = begin + len(row)
    path = put(tmp_path, cfg(form, edition=edition), content[:begin] + row + content[end:])
    with pytest.raises(UsageError, match=says):
        read_voltages(path, NAMES, None, 50.0)


REFUSED = {
    "no ratio": (cfg(ratio=",0,0,S"), dat(), "line 3: the values are secondary (S), and there is no ratio"),
    "no number": (cfg().replace("0.015625", "Zq7"), dat(), "line 3: its factor a is no number"),
    "few fields": (
        cfg().replace(",0.015625,-3.5,0,-32767,32767,1,1,P", "", 1),
        dat(),
        "needs 7 fields, and there are 5",
    ),
    "channels": (cfg().replace("4,3A,1D", "4,999999A,1D"), dat(), "line 2: there are more channels A than lines"),
    "no channels": (cfg().replace("4,3A,1D", "4,3,1"), dat(), "line 2: the number of channels A is missing"),
    "rates": (cfg(rates="999999\n1,1"), dat(), "more than 100000 sampling rates"),
    "samples": (cfg(rates=f"1\n{RATE_HZ},999999999"), dat(), f"holds {ROWS} of the 999999999 samples"),
    "cut": (cfg("BINARY"), dat("BINARY")[:-1], f"holds {ROWS - 1} of the {ROWS} samples"),
    "form": (cfg("BINARY8"), dat(), "is none of ASCII, BINARY, BINARY32, FLOAT32"),
    "end": (cfg().split("50\n")[0], dat(), "ends before the number of sampling rates, which line 8 should have"),
    "doubled": (cfg(names=["u_a_v", "u_a_v", "u_c_v"]), dat(), "channels 1 and 2 have the same name"),
    "text": (cfg(), dat().replace(b"\n7,", b"\nZq7,"), "line 7, column 1 of the samples (.dat) is no number"),
    "fields": (
        cfg(),
        dat().replace(b"\n7,", b"\n7,Zq7,"),
        "line 7 of the samples (.dat) has 7 fields where the configuration has 6",
    ),
    "order": (cfg(names=["u_a_v", "u_c_v", "u_b_v"]), dat(), "the phases follow in the order a, c, b"),
    "channel": (cfg(names=["x", "Zq7", "u_c_v"]), dat(), "no channel 'u_a_v' among its 4"),
    "far": (cfg().replace("0.015625", "1e300"), dat(), "goes beyond 1e+07 V"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_read_is_refused(tmp_path, what):
    """In one line with the file and the reason, and nothing of what is in it."""
    configuration, samples, says = REFUSED[what]
    with pytest.raises(UsageError) as refused:
        read_voltages(put(tmp_path, configuration, samples), NAMES, None, 50.0)
    said = str(refused.value)
    assert says in said
    assert said.startswith(f"{tmp_path / 'fault.cfg'}: ")
    assert "Zq7" not in said


def test_without_samples(tmp_path):
    """The other file is needed, and as much an ordinary one; a link of it that leads out of the folder is none."""
    path = put(tmp_path, cfg(), dat())
    (tmp_path / "fault.dat").rename(tmp_path.parent / f"{tmp_path.name}.dat")
    with pytest.raises(UsageError, match=r"there is no \.dat file beside it"):
        read_voltages(path, NAMES, None, 50.0)
    (tmp_path / "fault.dat").symlink_to(tmp_path.parent / f"{tmp_path.name}.dat")
    assert is_the_recording(read_voltages(path, NAMES, None, 50.0))
    with pytest.raises(UsageError, match="leads out of the folder"):
        read_voltages(path, NAMES, None, 50.0, tmp_path)


def why_refused(path):
    """The message about a recording that is not read, empty of one that is."""
    try:
        read_voltages(path, NAMES, None, 50.0)
    except UsageError as error:
        return str(error)
    return ""


def damaged(content, draw):
    """A file of which some bytes are others, gone or there twice."""
    content = bytearray(content)
    for _ in range(draw.randint(1, 3)):
        begin = draw.randrange(len(content))
        end = min(begin + draw.choice((1, 1, 2, 8, 100)), len(content))
        match draw.randrange(4):
            case 0:
                del content[begin:end]
            case 1:
                content[begin:end] = draw.randbytes(end - begin)
            case 2:
                content[begin:begin] = content[begin:end]
            case 3:
                content[begin:end] = draw.choice((b",", b"\n", b"-", b"9" * 30, b"1e999", b"nan", b"\xff\x00", b""))
        if not content:
            break
    return bytes(content)


@pytest.mark.parametrize("form", ["ASCII", "BINARY", "BINARY32", "FLOAT32"])
def test_any_damage_is_one_line(tmp_path, form):
    """A file with other bytes is read, or refused in one line: no traceback, no warning, no memory without end."""
    draw = random.Random(f"damage of {form}")
    refused = 0
    for _ in range(100):
        configuration, samples = cfg(form).encode(), dat(form)
        if draw.random() < 0.7:
            configuration = damaged(configuration, draw)
        else:
            samples = damaged(samples, draw)
        said = why_refused(put(tmp_path, configuration, samples))
        assert said.isprintable()
        refused += bool(said)
    assert refused > 20
