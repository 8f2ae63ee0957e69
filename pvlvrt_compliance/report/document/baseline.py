"""What a run's baseline makes of it: what it knows, what is worse, and what of it is out of date."""

from collections.abc import Iterable
from typing import NamedTuple

from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.verdicts import name_of
from pvlvrt_compliance.results import BaselineNote, Results, Verdict


class Said(NamedTuple):
    """What is said of one verdict; ``number`` is that of its test in the report, 0 where it is in none."""

    number: int
    test: str
    check: str
    verdict: Verdict | None
    text: str


class AgainstBaseline(NamedTuple):
    """A part of the report; ``parts`` has its lists by name, those that are not empty."""

    file: str
    share: str
    parts: dict[str, tuple[Said, ...]]
    is_out_of_date: bool


def against_baseline(results: Results) -> AgainstBaseline | None:
    """What the baseline of a run makes of it; None where there was none."""
    baseline = results.baseline
    if baseline is None:
        return None
    numbers = {test.key: (number, name_of(test, results)) for number, test in enumerate(results.tests, start=1)}
    said = [
        (Said(*numbers[test.key], verdict.check, verdict, verdict.worse or verdict.known_reason), verdict)
        for test, verdict in results.verdicts()
    ]
    parts = {
        "worse": tuple(each for each, verdict in said if verdict.worse),
        "known": tuple(each for each, verdict in said if verdict.is_known),
        "better": _notes(baseline.better, numbers),
        "gone": _notes(baseline.gone, numbers),
    }
    return AgainstBaseline(
        file=baseline.file,
        share=f"{100 * baseline.tolerance:g} %",
        parts={name: each for name, each in parts.items() if each},
        is_out_of_date=bool(baseline.better or baseline.gone),
    )


def said_of(said: Said, texts: Texts) -> str:
    """The reason or the words of one, in the language of ``texts`` where there is none of the file's own."""
    return said.text or texts("baseline.no_reason")


def _notes(notes: Iterable[BaselineNote], numbers: dict[str, tuple[int, str]]) -> tuple[Said, ...]:
    return tuple(
        Said(*numbers.get(note.test, (0, note.test)), note.check, None, f"was {note.was}; now {note.now}")
        for note in notes
    )
