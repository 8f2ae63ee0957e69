"""The page that a CI service shows beside a change: how the run ended, what fails it, what is known, how near it is."""

from collections.abc import Iterable, Sequence

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report import marked
from pvlvrt_compliance.report.console import summary_line
from pvlvrt_compliance.report.gate import STOPS, Told, of_the_run, told, worst_first
from pvlvrt_compliance.report.joining import Joined, count, few, joined
from pvlvrt_compliance.report.provenance import out_of_range_in_words
from pvlvrt_compliance.report.verdicts import name_of
from pvlvrt_compliance.results import Results, Status
from pvlvrt_compliance.results.files import REPORT

_WORST = 5  # margins that are shown
_REASON = 300  # characters of a reason, of which a table of many rows has room for few
_NAME = 120
_HEADINGS = ("test", "check", "verdict", "margin", "clause", "why")
_LEAST_ROW = 4 * len(_HEADINGS)  # bytes of a row: a bar and two spaces a cell, and something in it


def comment(results: Results, room: int) -> str:
    """The page as Markdown of at most so many bytes; what there is no room for is counted.

    No link, no picture, nobody called: see `marked`. What fails the run comes first, then the least margins, then what
    the baseline knows, folded.
    """
    found = told(results)
    nothing = of_the_run(results, found)
    red = worst_first([each for each in found if each.outcome in STOPS] + ([nothing] if nothing else []))
    known = worst_first(each for each in found if each.verdict.is_known)
    head, margins, foot = _head(results, len(known)), _margins(results), ["", *_foot(results)]
    left = room - marked.size([*head, *margins, *foot])
    failures = _listed(f"{_count(red, 'verdict')} fail{'s' if len(red) == 1 else ''} the run", red, results, left)
    left -= marked.size(failures)
    baseline = _listed(_count(known, "known failure"), known, results, left, folded=True)
    return "\n".join([*head, *failures, *margins, *baseline, *foot]) + "\n"


def _head(results: Results, known: int) -> list[str]:
    """One word for the run, the one that its line of summary begins with; PASS alone would say that nothing fails."""
    verdict = results.counts_as
    word = spell.STATUS_WORD[verdict].upper()
    if known and verdict is Status.PASS:
        word = f"nothing worse than the baseline ({known} known failure{'' if known == 1 else 's'})"
    return [
        f"### {spell.STATUS_SYMBOL[verdict]} Grid code: {word}",
        "",
        marked.plain(summary_line(results)),
        *_out_of_range(results),
        *_out_of_date(results),
    ]


def _out_of_range(results: Results) -> list[str]:
    """Parameters of the controller that were allowed out of the range that it states."""
    words = out_of_range_in_words(results.provenance)
    return ["", f"Out of the range that the controller states: {marked.plain(words, _REASON)}."] if words else []


def _out_of_date(results: Results) -> list[str]:
    """How much of the baseline is out of date, and by what it is brought up to date."""
    baseline = results.baseline
    if baseline is None or not (baseline.better or baseline.gone):
        return []
    counts = f"{len(baseline.better)} better, {len(baseline.gone)} gone"
    update = marked.code(f"pvlvrt-check baseline update {baseline.file[:_NAME]}")
    return ["", f"Out of date in the baseline: {counts}; {update} brings it up to date."]


def _foot(results: Results) -> list[str]:
    """What was judged by what, and the run that has it all."""
    of = results.provenance
    codes = [profile.id for profile in results.profiles[:_WORST]]
    more = f" and {len(results.profiles) - _WORST} more" if len(results.profiles) > _WORST else ""
    parts = {
        "controller": (of.get("controller_name") or of.get("controller", ""),),
        "profile": codes,
        "pvlvrt-compliance": (of.get("versions", {}).get("pvlvrt-compliance", ""),),
        "run": (results.run_id,),
    }
    said = {name: ", ".join(marked.code(str(text)[:_NAME]) for text in texts if text) for name, texts in parts.items()}
    told = "; ".join(f"{name} {text}{more if name == 'profile' else ''}" for name, text in said.items() if text)
    return [f"<sub>{told}</sub>"] if told else []


def _margins(results: Results) -> list[str]:
    """Of each check that has passed somewhere the nearest that it came to failing, the least of these."""
    found: dict[str, tuple[str, ...]] = {}
    for test, verdict in results.worst_margins(len(results.verdicts())):
        if verdict.status is Status.PASS and not verdict.worse and verdict.check not in found:
            found[verdict.check] = (
                marked.plain(name_of(test, results), _NAME),
                marked.plain(verdict.check, _NAME),
                marked.plain(spell.row(verdict).margin),
                _share(verdict.relative_margin),
                spell.verdict_in_words(verdict),
            )
    rows = list(found.values())[:_WORST]
    headings = ("test", "check", "margin", "of the limit", "verdict")
    return ["", "**Least margins of what passed**", "", *marked.table(headings, rows)] if rows else []


def _share(share: float | None) -> str:
    return "" if share is None else spell.number(100 * share, "%", decimals=0 if abs(share) >= 1 else 1, sign=True)


def _listed(heading: str, found: Sequence[Told], results: Results, room: int, *, folded: bool = False) -> list[str]:
    """Verdicts as a table of at most so many bytes, a row a reason, with a heading; nothing of none."""
    if not found:
        return []
    groups = joined(found)
    rows = [_cells(group, results) for group in groups[: max(room, 0) // _LEAST_ROW]]
    for shown in _fewer(len(rows)):
        more = count(groups[shown:])
        said = ["", f"{more} more: {REPORT} has all of them."] if more else []
        lines = [*(marked.table(_HEADINGS, rows[:shown]) if shown else []), *said]
        made = ["", *(marked.folded(heading, lines) if folded else [f"**{heading}**", "", *lines])]
        if marked.size(made) <= room:
            return made
    return []


def _fewer(count: int) -> Iterable[int]:
    """A number, and ever smaller ones down to none: a quarter less each time."""
    while count:
        yield count
        count = count * 3 // 4
    yield 0


def _cells(group: Joined, results: Results) -> tuple[str, ...]:
    """Its numbers but for the margin stand in its reason: a table of more columns leaves that no room."""
    verdict = group.first.verdict
    clauses = {each.verdict.clause for each in group.members}
    return (
        marked.plain(few([name_of(test, results) for test in group.tests]), _NAME),
        marked.plain(few(group.names), _NAME),
        spell.verdict_in_words(verdict),
        marked.plain(spell.row(verdict).margin, _NAME),
        marked.plain(verdict.clause if len(clauses) == 1 else "", _NAME),
        marked.plain(group.first.reason, _REASON),
    )


def _count(found: Sequence[Told], noun: str) -> str:
    return f"{len(found)} {noun}{'' if len(found) == 1 else 's'}"
