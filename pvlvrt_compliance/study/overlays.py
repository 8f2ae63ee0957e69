"""The records of both runs where most has changed, measured again so that they can be laid over each other.

Nothing is judged: the verdicts are those of the runs.
"""

import json
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.evidence.collect import collect_without_profile
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import Rating, TestResult
from pvlvrt_compliance.results.changes import Change, Key
from pvlvrt_compliance.results.comparison import Changed, Comparison
from pvlvrt_compliance.study.comparing import Side
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Waveforms
from pvlvrt_compliance.waveforms.recording import read_waveforms

MOST = 6
"""How many changes are drawn: a page stays one that is read (chosen)."""

LEAST_MOVED = 0.01
"""Share of its limit that a margin must have lost or gained to be drawn: less is not seen in a figure (chosen)."""

_KINDS = (("verdict", Change.WORSE), ("margin", Change.WORSE), ("verdict", Change.BETTER), ("margin", Change.BETTER))
"""What is drawn, in this order, behind all regressions."""


class Seen(NamedTuple):
    """A test of one run: its verdicts, and its record, measured."""

    evidence: Evidence
    result: TestResult


Draw = Callable[[Changed, Seen, Seen], Any]


class Overlays(NamedTuple):
    """What was drawn of changes, and why others were not, a sentence each."""

    made: dict[Key, Any]
    left_out: tuple[str, ...]


class _NotThere(Exception):  # noqa: N818 - it is an answer, not an error
    """Raised where a run has no record of a test; the text is the reason."""


def overlays_of(comparison: Comparison, old: Side, new: Side, draw: Draw, most: int = MOST) -> Overlays:
    """Draw the changes that matter most: regressions, then lost margins, better verdicts and gained margins.

    Parameters
    ----------
    comparison : Comparison
        Of the two runs.
    old, new : Side
        With the folders that their waveforms are named from.
    draw : callable
        Makes something of a change and of both records.
    most : int
        How many are drawn. Of tests that differ in their point on wave alone, as the runs of a row do, it is the worst.
    """
    records = (_Records(old), _Records(new))
    made: dict[Key, Any] = {}
    reasons: dict[str, None] = {}
    for change in _worth_seeing(comparison, records):
        if len(made) == most:
            break
        try:
            made[change.key] = draw(change, *(of.seen(change.test) for of in records))
        except _NotThere as reason:
            reasons[str(reason)] = None
        except PvlvrtError as error:
            reasons[f"{change.test}: {error}"] = None
    return Overlays(made, tuple(reasons))


def _worth_seeing(comparison: Comparison, records: "tuple[_Records, _Records]") -> list[Changed]:
    """What has changed in a way that a figure shows, kind by kind, the largest of each check before others."""
    found: dict[tuple[str, ...], Changed] = {}
    for change in comparison.changes:
        if change.new is not None and _is_seen(change):
            row = records[1].row(change.test)
            found.setdefault((change.new.check, change.new.stretch, change.change, row), change)
    place: Counter[tuple[int, str]] = Counter()
    ranked = []
    for (check, *_), change in found.items():
        kind = (-1 if change.regression else _KINDS.index((change.what, change.change)), check)
        ranked.append((kind[0], place[kind], change))
        place[kind] += 1
    return [change for *_, change in sorted(ranked, key=lambda one: one[:2])]


def _is_seen(change: Changed) -> bool:
    if change.old is None or change.new is None:
        return False
    return change.regression or change.what == "verdict" or abs(change.margin_lost or 0.0) >= LEAST_MOVED


class _Records:
    """The records of one run; the last one stays, for changes of one test often follow each other."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self._tests = {test.key: test for test in side.results.tests}
        self._last: tuple[str, Seen] | None = None

    def row(self, test: str) -> str:
        """What a test shares with the other runs of its row: its profile and its scenario but for the point on wave."""
        found = self._tests[test]
        if not found.scenario:
            return test
        asked = {name: value for name, value in found.scenario.items() if name != "point_on_wave_deg"}
        return json.dumps([found.profile, asked], sort_keys=True)

    def seen(self, test: str) -> Seen:
        """A test with its record.

        Raises
        ------
        _NotThere
            When there is none, or it cannot be told what it is of.
        UsageError
            When it cannot be read.
        """
        if self._last is None or self._last[0] != test:
            self._last = (test, self._read(test))
        return self._last[1]

    def _read(self, test: str) -> Seen:
        result = self._tests.get(test)
        if result is None or result.waveforms is None:
            raise _NotThere(f"{self._side.name} kept no waveforms of some tests (--waveforms all keeps them)")
        if result.disturbance is None or result.rating is None:
            raise _NotThere(f"{self._side.name} was written by a version that does not say what the grid did")
        file = self._file(result.waveforms)
        waveforms = read_waveforms(file, within=self._side.folder)
        return Seen(_evidence(waveforms, result, result.disturbance, result.rating), result)

    def _file(self, name: str) -> Path:
        """The file of a record; nothing is opened outside of the folder that the results lie in."""
        folder = self._side.folder.resolve()
        file = (folder / name).resolve()
        if not file.is_relative_to(folder):
            raise _NotThere(f"{self._side.name} names waveforms outside of its folder")
        if not file.is_file():
            raise _NotThere(f"{self._side.folder / name} is not there")
        return self._side.folder / name


def _evidence(waveforms: Waveforms, result: TestResult, disturbance: Disturbance, rating: Rating) -> Evidence:
    nominal = Nominal(
        apparent_power_va=1e3 * rating.apparent_power_kva,
        phase_voltage_v=rating.phase_voltage_v,
        frequency_hz=rating.frequency_hz,
    )
    available_w = 1e3 * (result.available_power_kw or 0.0)
    return collect_without_profile(waveforms, nominal, disturbance, available_w, result.measurements)
