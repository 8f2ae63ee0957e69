"""`badge.svg`: how a run ended, in two words and a count of tests, as a picture that needs no network."""

from collections.abc import Mapping
from html import escape

from pvlvrt_compliance.report.console import summary_line
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.gate import tests
from pvlvrt_compliance.report.verdicts import part_of
from pvlvrt_compliance.results import Results, Status
from pvlvrt_compliance.results.files import BADGE

FILE = BADGE
ASKED_FOR = True

LABEL = "grid code"

# White text on each of them has a contrast of 4.5 and more; the words say the same without a colour.
_GROUND = "#40474d"
_PASS, _KNOWN, _FAIL, _UNJUDGED = "#176f31", "#7a4b00", "#b3161b", "#545c63"
_COLOUR = {Status.FAIL: _FAIL}

_HEIGHT, _SIZE, _PADDING, _ROUND = 20, 11, 6, 3  # px
# Advances of Verdana in thousandths of its size; where another font stands in, the text is set to the same length.
_ADVANCES = {
    " ": 352, ",": 364, "/": 454,
    "a": 601, "b": 623, "c": 521, "d": 623, "e": 596, "f": 352, "g": 623, "h": 633, "i": 274, "j": 344, "k": 592,
    "l": 274, "m": 973, "n": 633, "o": 607, "p": 623, "q": 623, "r": 427, "s": 521, "t": 394, "u": 633, "v": 592,
    "w": 818, "x": 592, "y": 592, "z": 525,
}  # fmt: skip
_OTHERS = 636  # digits are all as wide


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> str:  # noqa: ARG001
    """Return the badge as SVG; all its words are of this file."""
    message = in_words(results)
    part = _part_in_words(results)
    first, second = _width(LABEL), _width(message)
    whole = first + second
    said = escape("; ".join(filter(None, [f"{LABEL}: {message}", part])))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{whole}" height="{_HEIGHT}" viewBox="0 0 {whole} {_HEIGHT}"'
        f' role="img" aria-label="{said}">\n'
        f"<title>{said}</title>\n"
        f"<desc>{escape(summary_line(results))}; run {escape(results.run_id)}</desc>\n"
        f'<path d="{_half(0, first, left=_ROUND, right=0)}" fill="{_GROUND}"/>\n'
        f'<path d="{_half(first, second, left=0, right=_ROUND)}" fill="{_colour(results, is_part=bool(part))}"/>\n'
        f'<g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="{_SIZE}">'
        f"{_text(LABEL, 0)}{_text(message, first)}</g>\n"
        "</svg>\n"
    )


def in_words(results: Results) -> str:
    """What the badge says behind its label: ``pass 27/27``, ``fail 2/27``, ``pass 24/27, 3 known``.

    Of a part of the tests ``pass 1 of 27``, all that the profiles have, and of a part of the checks that it is one.
    """
    count, part = tests(results), part_of(results)
    others = part.not_selected + part.not_run
    of_all = f" of {count.all + others}" if others else f"/{count.all}"
    checks = ", some checks" if part.checks else ""
    if results.counts_as is Status.PASS:
        known = f", {count.known} known" if count.known else ""
        return f"pass {count.good}{of_all}{known}{checks}"
    word = {Status.FAIL: "fail", Status.ERROR: "error"}.get(results.counts_as, "not judged")
    return f"{word} {count.red}{of_all}{checks}" if count.red else word


def _part_in_words(results: Results) -> str:
    """That the run is a part, and of what; in words of ours alone, and empty of a whole run."""
    part = part_of(results)
    counts = {"not selected": part.not_selected, "not run": part.not_run}
    pieces = [f"{count} test{'' if count == 1 else 's'} {what}" for what, count in counts.items() if count]
    pieces += ["some checks only"] * bool(part.checks)
    return f"a partial run: {', '.join(pieces)}" if pieces else ""


def _colour(results: Results, *, is_part: bool) -> str:
    """Green is a whole run alone."""
    if results.counts_as is not Status.PASS:
        return _COLOUR.get(results.counts_as, _UNJUDGED)
    if tests(results).known:
        return _KNOWN
    return _UNJUDGED if is_part else _PASS


def _width(text: str) -> int:
    """Width of a half of the badge (px), even, so that its middle is a whole number."""
    return 2 * round(_length(text) / 2) + 2 * _PADDING


def _length(text: str) -> float:
    return _SIZE * sum(_ADVANCES.get(each, _OTHERS) for each in text) / 1000


def _half(x: int, width: int, *, left: int, right: int) -> str:
    """Outline of a half with rounded corners on either side; a clip path would need an id, one a page."""
    down = _HEIGHT
    return (
        f"M{x + left} 0H{x + width - right}a{right} {right} 0 0 1 {right} {right}V{down - right}"
        f"a{right} {right} 0 0 1 {-right} {right}H{x + left}a{left} {left} 0 0 1 {-left} {-left}V{left}"
        f"a{left} {left} 0 0 1 {left} {-left}z"
    )


def _text(text: str, left: int) -> str:
    length = _width(text) - 2 * _PADDING
    place = f'x="{left + _PADDING}" y="14" textLength="{length}" lengthAdjust="spacingAndGlyphs"'
    return f"<text {place}>{escape(text)}</text>"
