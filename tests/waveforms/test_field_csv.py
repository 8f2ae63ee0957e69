"""CSV as instruments and spreadsheets write it: the same waveform as in the plain form, or refused with the reason."""

import random

import numpy as np
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.playback import LARGEST_PLAYED_BYTES, read_voltages
from pvlvrt_compliance.waveforms.recording import read_waveforms

NAMES = ["u_a_v", "u_b_v", "u_c_v"]
STEP_S, ROWS, PEAK_V = 1e-3, 60, 325.25
TIMES = [round(k * STEP_S, 3) for k in range(ROWS)]
PHASES = [[round(PEAK_V * np.cos(2 * np.pi * (50 * t - k / 3)), 4) for t in TIMES] for k in range(3)]


def text(separator=",", comma=False, header=None, scale=1.0, quoted=False, end="", columns=(0, 1, 2), line="\n"):
    """The recording in one of the ways to write it."""

    def shown(value):
        number = f"{value:.12f}".replace(".", "," if comma else ".")
        return f'"{number}"' if quoted else number

    names = ["t_s", *(NAMES[k] for k in columns)] if header is None else header
    rows = [[shown(t), *(shown(PHASES[k][n] * scale) for k in columns)] for n, t in enumerate(TIMES)]
    return line.join(separator.join(row) + end for row in [names, *rows]) + line


def read(folder, content, channels=NAMES, scale=None, encoding="utf-8"):
    """What is played back of a file."""
    file = folder / "fault.csv"
    file.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
    return read_voltages(file, channels, scale, 50.0)


def is_the_recording(samples, channels=NAMES):
    """Whether these are the voltages that were written."""
    return (samples.t0_s, samples.dt_s) == (0.0, pytest.approx(STEP_S)) and all(
        np.allclose(samples[name], PHASES[k], rtol=0, atol=1e-6) for k, name in enumerate(channels)
    )


FORMS = {
    "plain": text(),
    "mark": "\ufeff" + text(),
    "semicolons": text(";"),
    "decimal comma": text(";", comma=True),
    "tabs with decimal comma": text("\t", comma=True),
    "quoted header": text(header=['"t_s"', '"u_a_v"', '"u_b_v"', '"u_c_v"']),
    "all quoted": text(";", comma=True, header=['"t_s"', '"u_a_v"', '"u_b_v"', '"u_c_v"'], quoted=True),
    "decimal comma in quotes": text(comma=True, quoted=True),
    "separator at every end": text(end=","),
    "semicolon at every end": text(";", comma=True, end=";;"),
    "separator at the end of numbers": text().replace("\n", ",\n").replace("u_c_v,\n", "u_c_v\n"),
    "lines of Windows": text(line="\r\n"),
    "lines of the past": text(line="\r"),
    "blank lines": text() + "\n,,,\n\n",
    "line of a spreadsheet": "sep=;\n" + text(";", comma=True),
    "blanks": text(", ", header=["t_s", " u_a_v", "u_b_v ", "u_c_v"]),
    "kV": text(header=["t_s", "u_a_kv", "u_b_kv", "u_c_kv"], scale=1e-3),
    "columns in the order a, c, b": text(columns=(0, 2, 1)),
}


@pytest.mark.parametrize("form", FORMS)
def test_each_form_is_the_same_recording(tmp_path, form):
    """Sample for sample."""
    assert is_the_recording(read(tmp_path, FORMS[form]))


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8", "utf-8-sig"])
def test_names_in_either_encoding(tmp_path, encoding):
    """A name with letters of any language is that which the events file has."""
    names = ["Außenleiter_a", "Größe b", "Phase ç µ"]
    content = text(";", header=["t_s", *names])
    assert is_the_recording(read(tmp_path, content, names, encoding=encoding), names)


def test_columns_that_are_not_read_may_hold_anything(tmp_path):
    """Doubled names, texts, nothing: only what is asked for is looked at."""
    lines = text(";").splitlines()
    content = "\n".join(f"{line};{more}" for line, more in zip(lines, ["note;note;", *["a,b.c;;"] * ROWS], strict=True))
    assert is_the_recording(read(tmp_path, content))


@pytest.mark.parametrize(
    ("ending", "scale", "factor"), [("pu", PEAK_V, 1 / PEAK_V), ("kv", 1.0, 1e-3), ("v", 2.0, 0.5)]
)
def test_a_scale_is_on_volts_or_on_per_unit(tmp_path, ending, scale, factor):
    """The volts of 1 pu; of what is in kV, a factor on volts."""
    names = [f"u_{phase}_{ending}" for phase in "abc"]
    content = text(header=["t_s", *names], scale=factor)
    assert is_the_recording(read(tmp_path, content, names, scale), names)


REFUSED = {
    "two fields of a number": (text(comma=True), "line 2 has 8 fields where the header has 4; numbers with a decimal"),
    "too few": (text() + "0.06,1\n", f"line {ROWS + 2} has 2 fields where the header has 4"),
    "both commas and points": (
        text(";", comma=True) + "0.06;1;2;3\n",
        f"line 2 has a decimal comma and line {ROWS + 2} a decimal point",
    ),
    "thousands": (text(";").replace("\n", "\n1.000,5;1;2;3\n", 1), "line 2, column 1 is no number"),
    "a line of units": (text().replace("\n", "\ns,V,V,V\n", 1), "line 2, column 1 is no number"),
    "a gap": (text() + "0.06,1,,3\n", f"line {ROWS + 2}, column 3 is empty"),
    "doubled": (text(header=["t_s", "u_a_v", "u_b_v", "u_b_v"]), "columns 3 and 4 have the same name"),
    "doubled times": (text(header=["t_s", "t_s", "u_b_v", "u_b_v"]), "columns 1 and 2 have the same name"),
    "not finite": (text() + "0.06,1,inf,3\n", f"'u_b_v' has no finite number at its sample {ROWS + 1}"),
    "UTF-16": (text().encode("utf-16"), "not UTF-8 text: it is UTF-16"),
    "zeros": (text().encode() + b"\0", "bytes that are zero"),
    "nothing": ("", "line 1: there is no column t_s"),
    "header alone": ("t_s,u_a_v,u_b_v,u_c_v\n", "two samples at least"),
    "one sample": ("t_s,u_a_v,u_b_v,u_c_v\n0,1,2,3\n", "two samples at least"),
    "time that stands": (text() + text().splitlines()[-1], "the times do not increase"),
    "per unit": (text(header=["t_s", "u_a_pu", "u_b_pu", "u_c_pu"]), "no channel 'u_a_v' among its 4"),
    "another order": (
        text(header=["t_s", "u_a_v", "u_c_v", "u_b_v"]),
        'the phases follow in the order a, c, b; name them so: channels = ["u_a_v", "u_c_v", "u_b_v"]',
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_read_is_refused(tmp_path, what):
    """In one line with the file and the reason, and where there is one with line and column."""
    content, says = REFUSED[what]
    with pytest.raises(UsageError) as refused:
        read(tmp_path, content)
    assert says in str(refused.value)
    assert str(refused.value).startswith(f"{tmp_path / 'fault.csv'}: ")
    assert "\n" not in str(refused.value)


def test_a_base_is_not_guessed(tmp_path):
    """Per unit is of the amplitude for some, of the RMS value for others, and currents are no voltage."""
    for ending, says in (("pu", "is per unit, of a base that the file does not say: give scale"), ("a", "no voltage")):
        names = [f"i_{phase}_{ending}" for phase in "abc"]
        with pytest.raises(UsageError, match=says):
            read(tmp_path, text(header=["t_s", *names]), names)


def test_a_large_file_is_not_read(tmp_path):
    """One with a hole in it costs nothing."""
    with (tmp_path / "fault.csv").open("wb") as file:
        file.truncate(LARGEST_PLAYED_BYTES + 1)
    with pytest.raises(UsageError, match="larger than 64 MiB, which a recording may have"):
        read_voltages(tmp_path / "fault.csv", NAMES, None, 50.0)


@pytest.mark.parametrize("form", FORMS)
def test_a_whole_record_is_read_as_well(tmp_path, form):
    """What is judged has all columns by their names, in V."""
    (tmp_path / "record.csv").write_text(FORMS[form], "utf-8")
    (found,) = read_waveforms(tmp_path / "record.csv")
    assert set(found.channels) == set(NAMES)
    assert is_the_recording(found)


def test_of_a_whole_record_no_name_is_there_twice(tmp_path):
    """Which of the two is judged would be anybody's guess."""
    (tmp_path / "record.csv").write_text(text(header=["t_s", "x", "u_b_v", "x"]), "utf-8")
    with pytest.raises(UsageError, match="columns 2 and 4 have the same name"):
        read_waveforms(tmp_path / "record.csv")


@pytest.mark.parametrize("ending", ["pu", "pu and more"])
def test_of_a_whole_record_nothing_is_taken_for_volts(tmp_path, ending):
    """Per unit is refused where it is one of the channels that are judged, and read where it is another's."""
    names = [f"u_{phase}_pu" if ending == "pu" else f"soc_{phase}_pu" for phase in "abc"]
    (tmp_path / "record.csv").write_text(text(header=["t_s", *names]), "utf-8")
    if ending == "pu":
        with pytest.raises(UsageError, match="'u_a_pu' is per unit, of a base that the file does not say"):
            read_waveforms(tmp_path / "record.csv")
    else:
        assert read_waveforms(tmp_path / "record.csv").names == tuple(names)


def damaged(content, draw):
    """A file of which some bytes are others, gone or there twice."""
    content = bytearray(content)
    for _ in range(draw.randint(1, 3)):
        begin = draw.randrange(len(content))
        end = min(begin + draw.choice((1, 1, 2, 8, 100)), len(content))
        others = (b",", b"\n", b'"', b";", b"-", b"9" * 30, b"1e999", b"nan", b"\xff\x00", b"\t", b"\r", b"", b"#")
        content[begin:end] = draw.choice((draw.randbytes(end - begin), 2 * content[begin:end], *others))
    return bytes(content)


@pytest.mark.parametrize("form", ["plain", "decimal comma", "all quoted"])
def test_any_damage_is_one_line(tmp_path, form):
    """A file with other bytes is read, or refused in one line: no traceback and no warning."""
    draw = random.Random(f"damage of {form}")
    refused = 0
    for _ in range(150):
        said = why_refused(tmp_path, damaged(FORMS[form].encode(), draw))
        assert said.isprintable()
        refused += bool(said)
    assert refused > 50


def why_refused(folder, content):
    """The message about a recording that is not read, empty of one that is."""
    try:
        read(folder, content)
    except UsageError as error:
        return str(error)
    return ""


SECRET = "root:x:0:0:Zq7secret:/root:/bin/bash"


@pytest.mark.parametrize("place", ["header", "line", "field", "name", "number", "quoted"])
def test_nothing_of_a_file_is_in_a_message(tmp_path, place):
    """Wherever it stands: who names a file for others to read learns nothing from it."""
    header, *rows = text().splitlines()
    written = {
        "header": [SECRET, *rows],
        "line": [header, SECRET, *rows],
        "field": [header, f"0,{SECRET},0,0", *rows],
        "name": [f"t_s,u_a_v,u_b_v,{SECRET}", *rows],
        "number": [header, "0,1e5Zq7secret,0,0", *rows],
        "quoted": [f'"t_s","u_a_v","{SECRET},u_b_v', *rows],
    }[place]
    with pytest.raises(UsageError) as refused:
        read(tmp_path, "\n".join(written))
    assert "Zq7" not in str(refused.value)
    assert "root" not in str(refused.value).replace(str(tmp_path), "")
