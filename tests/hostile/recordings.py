"""Recordings as laboratories, relays and other programs write them: CSV of several manners, COMTRADE."""

import math
import struct
from collections.abc import Sequence
from random import Random

from tests.hostile.damage import File, damaged_bytes, damaged_file

NAMES = ("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "v_dc_v", "connected")
_RATE_HZ = 1000.0

Rows = list[list[float]]


def rows(length_s: float = 0.9, depth: float = 0.5) -> Rows:
    """A sag of 0.2 s from 0.3 s on: time, three voltages, three currents, the link, and that it is connected."""
    made = []
    for k in range(int(length_s * _RATE_HZ)):
        t = k / _RATE_HZ
        level = 1 - depth if 0.3 <= t < 0.5 else 1.0
        angles = [2 * math.pi * (50 * t - phase / 3) for phase in range(3)]
        u = [325.27 * level * math.cos(angle) for angle in angles]
        i = [1000.0 * math.cos(angle) for angle in angles]
        made.append([t, *u, *i, 760.0, 1.0])
    return made


def csv_text(rng: Random, made: Rows) -> str:
    """A table as programs write it: other separators, decimal commas, quotation marks, units, a comma at the end."""
    separator, comma = rng.choice(((",", "."), (",", "."), (",", "."), (";", ","), (";", "."), ("\t", ".")))
    names = ["t_s", *NAMES]
    if rng.random() < 0.15:
        names = [f'"{name}"' for name in names]
    if rng.random() < 0.1:
        names = rng.choice((["Time", "Va", "Vb", "Vc", *NAMES[3:]], [name.upper() for name in names], names[::-1]))
    if rng.random() < 0.1:
        names[rng.randrange(len(names))] = rng.choice(names)
    scale = rng.choice((1.0, 1.0, 1.0, 1e-3, 1 / 325.27))
    end = rng.choice(("", "", "", separator, " "))
    lines = [separator.join(names) + end]
    for t, *others in made:
        cells = [t, *(x * scale for x in others[:3]), *others[3:]]
        lines.append(separator.join(f"{cell:.6g}".replace(".", comma) for cell in cells) + end)
    return rng.choice(("", "", "\ufeff")) + "\n".join(lines) + "\n"


def csv_file(rng: Random) -> File:
    """A table, whole or damaged."""
    text = csv_text(rng, rows())
    if rng.random() < 0.25:
        return File(text.encode(rng.choice(("utf-8", "latin-1", "utf-16")), "replace"))
    return damaged_file(text, rng)


def comtrade_files(rng: Random, name: str) -> dict[str, File]:
    """Both files of a record, one of them damaged, or none."""
    made = rows()
    kind = rng.choice(("ASCII", "BINARY", "BINARY32", "FLOAT32"))
    config, data = _config(made, kind, rng), _data(made, kind)
    files = {f"{name}.cfg": File(config.encode()), f"{name}.dat": File(data)}
    deed = rng.random()
    if deed < 0.55:
        files[f"{name}.cfg"] = damaged_file(config, rng)
    elif deed < 0.8:
        files[f"{name}.dat"] = File(damaged_bytes(data, rng))
    elif deed < 0.87:
        del files[rng.choice((f"{name}.cfg", f"{name}.dat"))]
    return files


def _config(made: Rows, kind: str, rng: Random) -> str:
    analog, scale = NAMES[:-1], 1.0 if kind == "FLOAT32" else 0.05
    year = rng.choice(("1999", "2013", "2013", "1991"))
    sides = (f",1,1,{rng.choice('PS')}",) if year != "1991" else ("",)
    lines = [f"station,device,{year}", f"{len(analog) + 1},{len(analog)}A,1D"]
    for k, name in enumerate(analog, start=1):
        unit = "V" if name.endswith("_v") else "A"
        lines.append(f"{k},{name},{'ABC'[(k - 1) % 3]},,{unit},{scale},0,0,-32767,32767{sides[0]}")
    lines += [f"1,{NAMES[-1]},,,0", "50", "1", f"{_RATE_HZ},{len(made)}"]
    lines += ["01/01/2020,00:00:00.000000", "01/01/2020,00:00:00.300000", kind]
    lines += ["1"] * (year != "1991")
    lines += ["0,0", "0,0"] * (year == "2013")
    return "\r\n".join(lines) + "\r\n"


def _data(made: Rows, kind: str) -> bytes:
    if kind == "ASCII":
        return "".join(f"{','.join(map(str, _sample(k, row)))}\r\n" for k, row in enumerate(made, start=1)).encode()
    if kind == "FLOAT32":
        floats = ((k, round(1e6 * row[0]), *row[1:-1], 1) for k, row in enumerate(made, start=1))
        return b"".join(struct.pack(f"<2I{len(NAMES) - 1}fH", *each) for each in floats)
    word = "h" if kind == "BINARY" else "i"
    return b"".join(struct.pack(f"<2I{len(NAMES) - 1}{word}H", *_sample(k, row)) for k, row in enumerate(made, start=1))


def _sample(number: int, row: Sequence[float]) -> list[int]:
    return [number, round(1e6 * row[0]), *(round(x / 0.05) for x in row[1:-1]), 1]
