"""What files of recordings have in common: columns by name, each in a unit, and how what is wrong with them is told."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.waveforms.container import Samples, unit_of

PER_UNIT = "pu"
"""Unit of what is a share of a base that the file does not say."""

_UNITS = {
    **dict.fromkeys(("V", "VOLT", "VOLTS"), ("V", 1.0)),
    **dict.fromkeys(("A", "AMP", "AMPS"), ("A", 1.0)),
    "KV": ("V", 1e3),
    "KA": ("A", 1e3),
    "PU": (PER_UNIT, 1.0),
}
_BY_CASE = {"mV": ("V", 1e-3), "MV": ("V", 1e6), "mA": ("A", 1e-3), "MA": ("A", 1e6)}
_ENDINGS = {"_kv": "kV", "_ka": "kA", "_pu": PER_UNIT}
_OURS = re.compile(r"(u0?_[abc]_v|i_[abc]_a)")
_THOUSANDS = {"_kv": "_v", "_ka": "_a"}  # endings of names, and those of the same in V and A


class DamagedError(Exception):
    """Why a file is no recording: the line and the place, and nothing of what stands there."""


class NoChannelError(Exception):
    """There is no column of a name that was asked for; it has those names besides, which are not for messages."""

    def __init__(self, name: str, others: Sequence[str]) -> None:
        super().__init__(name)
        self.name, self.others = name, others


class Column(NamedTuple):
    """Samples of one channel, shape (n,)."""

    samples: Samples
    unit: str  # V, A, pu, or as the file has it


class Chosen(NamedTuple):
    """A column of a file that is read."""

    name: str  # that it is asked for by
    place: int  # from 0
    unit: str  # by the ending of its own name in the file


def chosen(names: Sequence[str], wanted: Sequence[str] | None, one: str = "column", first: int = 1) -> list[Chosen]:
    """Which columns are read.

    A column in kV or kA by the ending of its name is that in V or A where there is none of that name.

    Parameters
    ----------
    names : sequence of str
        Of all columns, in their order; one without a name is not read.
    wanted : sequence of str or None
        Names that are asked for; None: all.
    one : str
        What a column is called in messages.
    first : int
        Number of the first one in messages.

    Raises
    ------
    DamagedError
        When two have the name of one that is read.
    NoChannelError
        When one is not there.
    """
    found = []
    for name in dict.fromkeys(filter(None, names)) if wanted is None else wanted:
        bare = name.strip()  # as names of a file are read
        own = bare if bare in names else next((n for n in names if n and _plain(n) == bare), None)
        if own is None:
            raise NoChannelError(name, names)
        places = [k for k, other in enumerate(names) if other == own]
        if len(places) > 1:
            said = f"{one}s {places[0] + first} and {places[1] + first} have the same name"
            raise DamagedError(f"{said}; which is meant is not known")
        asked = name if wanted is not None or _plain(name) in names else _plain(name)
        found.append(Chosen(asked, places[0], unit_by_name(own)))
    return found


def unit_by_name(name: str) -> str:
    """Unit of a voltage or a current by the name of its column, empty where that does not say it.

    Of names that are not ours only kV, kA and pu: what else ends in ``_a`` is a phase more often than a current.
    """
    known = next((unit for ending, unit in _ENDINGS.items() if name.endswith(ending)), "")
    return known or (unit_of(name) if _OURS.fullmatch(name) else "")


def in_units(samples: Samples, unit: str) -> Column:
    """Samples in V or A where their unit is one of voltage or current; others as they are."""
    known = _BY_CASE.get(unit) or _UNITS.get(unit.replace(".", "").upper())
    if known is None:
        return Column(samples, unit)
    return Column(samples if known[1] == 1 else known[1] * samples, known[0])


def number(text: str) -> float | None:
    """A number as every programming language writes it; None of any other text."""
    try:
        return None if "_" in text else float(text)
    except ValueError:
        return None


def _plain(name: str) -> str:
    ending = name[-3:]
    return name.removesuffix(ending) + _THOUSANDS[ending] if ending in _THOUSANDS else name
