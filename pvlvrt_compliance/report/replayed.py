"""Files of a replay: the outputs as they can be expected of another one, and the figure."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.agreement import Agreement
from pvlvrt_compliance.waveforms.container import Segment
from pvlvrt_compliance.waveforms.csv import exact_text


class Replayed(NamedTuple):
    """What files are made of."""

    title: str
    outputs: Segment
    units: Mapping[str, str]
    agreements: Sequence[Agreement]


def as_csv(of: Replayed) -> str:
    """The outputs, numbers as they are."""
    return exact_text(of.outputs.t_s, of.outputs.channels)


def as_page(of: Replayed) -> str:
    """The outputs as figures, beside what was expected of them."""
    from pvlvrt_compliance.report.drawing import page
    from pvlvrt_compliance.report.drawing.of_replay import panels

    return page.render("Replay", of.title, panels(of.outputs, of.units, of.agreements))


_MADE: Mapping[str, Callable[[Replayed], str]] = {".csv": as_csv, ".html": as_page}


def refuse_unknown(names: Sequence[str], option: str) -> None:
    """Refuse files that are nothing which is made here.

    Raises
    ------
    UsageError
        With the endings that are known; ``option`` is how they were asked for.
    """
    for name in names:
        if Path(name).suffix.lower() not in _MADE:
            raise UsageError(f"{option} {name}: the name must end in {' or '.join(_MADE)}")


def files_of(names: Sequence[str], of: Replayed) -> dict[Path, bytes]:
    """The content of files, by their names."""
    return {Path(name): _MADE[Path(name).suffix.lower()](of).encode() for name in names}
