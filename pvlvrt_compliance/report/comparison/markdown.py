"""A comparison as Markdown, for the comments of a merge request: what is worse in full, what moves in short."""

from collections.abc import Sequence

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report import marked
from pvlvrt_compliance.report.comparison.words import (
    MOST,
    Part,
    WholeTest,
    cells_of,
    differences_in_words,
    parts_of,
    profiles_in_words,
    summary,
)
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results.comparison import Changed, Comparison
from pvlvrt_compliance.results.verdict import Verdict

_MOST_OF = {"worse": 40, "gone": 15, "added": 15}
"""Rows of a part that are shown; of any other `MOST`. With names as long as they may be it is a comment still."""

_NAME, _LINE = 120, 300  # characters that are shown of a name, and of a sentence
_COLUMNS = ("test", "check", "was", "is", "margin_was", "margin_is", "share")


def render(comparison: Comparison, texts: Texts) -> str:
    """Return the comparison as Markdown as GitHub and GitLab read it, in a language; no text in it is markup."""
    lines = [
        f"### {marked.plain(summary(comparison, texts))}",
        "",
        f"- {texts('comparison.old')}: {_run(comparison.old.name, comparison.old.controller)}",
        f"- {texts('comparison.new')}: {_run(comparison.new.name, comparison.new.controller)}",
    ]
    profiles = profiles_in_words(comparison.profiles, texts)
    lines += [*(f"- **{marked.plain(line, _LINE)}**" for line in profiles[:MOST]), *_more(profiles[MOST:], texts)]
    for part in parts_of(comparison):
        lines += ["", *_part(part, texts)]
    if said := differences_in_words(comparison.differences, texts):
        shown = [f"- {marked.plain(line, _LINE)}" for line in said[: 2 * MOST]]
        lines += ["", f"**{texts('comparison.differs')}**", "", *shown, *_more(said[2 * MOST :], texts)]
    return "\n".join(lines) + "\n"


def _run(name: str, controller: str) -> str:
    own = f" ({marked.code(controller[:_NAME])})" if controller not in ("", name) else ""
    return f"{marked.code(name[:_NAME])}{own}"


def _part(part: Part, texts: Texts) -> list[str]:
    most = _MOST_OF.get(part.key, MOST)
    rows = [_test(test, texts) for test in part.tests[:most]] + [_row(change, texts) for change in part.changes[:most]]
    return [
        f"**{texts(f'comparison.part.{part.key}')} ({part.verdicts})**",
        "",
        *marked.table([texts(f"comparison.column.{name}") for name in _COLUMNS], rows),
        *_more([*part.tests[most:], *part.changes[most:]], texts),
    ]


def _more(left_out: Sequence[object], texts: Texts) -> list[str]:
    return ["", texts("comparison.more", count=len(left_out))] if left_out else []


def _test(test: WholeTest, texts: Texts) -> list[str]:
    status = ["" if one is None else texts.named("status", one) for one in test.statuses]
    count = texts("comparison.verdicts", count=len(test.changes))
    return [_name(test.name, test.is_regression), count, *status, "", "", ""]


def _row(change: Changed, texts: Texts) -> list[str]:
    status = [_status(one, texts) for one in (change.old, change.new)]
    numbers = [marked.plain(cell, _NAME) for cell in cells_of(change, texts)]
    return [marked.plain(change.test, _NAME), _name(change.check, change.regression), *status, *numbers]


def _name(name: str, is_regression: bool) -> str:
    said = marked.plain(name, _NAME)
    return f"**{said}**" if is_regression and said else said


def _status(verdict: Verdict | None, texts: Texts) -> str:
    return "" if verdict is None else spell.verdict_in_words(verdict, texts)
