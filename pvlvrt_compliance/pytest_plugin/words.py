"""What a test of pytest says of verdicts."""

from collections.abc import Iterable, Sequence

from pvlvrt_compliance.report.format import STATUS_WORD
from pvlvrt_compliance.report.gate import STOPS, Outcome, Told, numbers_in_words, worst_first
from pvlvrt_compliance.report.joining import count, few, joined

_MOST = 20


def red_in_words(found: Sequence[Told]) -> str:
    """The verdicts that stop a run: in a line which they are, then each with its numbers, as many as somebody reads.

    Those that share a reason have it once.
    """
    red = joined(worst_first(each for each in found if each.outcome in STOPS))
    lines = [", ".join(dict.fromkeys(f"{few(each.names)} {STATUS_WORD[each.first.verdict.status]}" for each in red))]
    for each in red[:_MOST]:
        tests, numbers = [test.key for test in each.tests], numbers_in_words(*(of.verdict for of in each.members))
        lines += [f"{few(tests, _MOST)}, {few(each.names, _MOST)}: {each.first.reason}", f"    {numbers}".rstrip()]
    if left := count(red[_MOST:]):
        lines.append(f"and {left} more")
    return "\n".join(filter(None, lines))


def reasons(found: Iterable[Told], outcome: Outcome) -> str:
    """Why verdicts are what they are to a gate, each reason once."""
    groups = joined(each for each in found if each.outcome is outcome)
    return "; ".join(dict.fromkeys(f"{few(each.names, _MOST)}: {each.first.reason}" for each in groups))
