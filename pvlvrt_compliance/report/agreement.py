"""How outputs agree with what was expected of them: as lines for a terminal, and as plain data for programs."""

from collections.abc import Iterator, Sequence
from typing import Any

from pvlvrt_compliance.waveforms.agreement import Agreement, Difference
from pvlvrt_compliance.waveforms.container import Segment

_HEADINGS = ("output", "unit", "largest error", "at", "of the peak", "rms", "allowed", "")


def lines(title: str, outputs: Segment, agreements: Sequence[Agreement]) -> Iterator[str]:
    """What is printed: the controller, a row an output, and where each that is outside differs first."""
    yield f"{title}: {len(outputs)} samples of {1e6 * outputs.dt_s:g} us"
    rows = [_HEADINGS, *map(_row, agreements)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(_HEADINGS))]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
    for each in agreements:
        yield from _first(each)
    outside = sum(not each.is_inside for each in agreements)
    all_of = f"{len(agreements)} output{'s' * (len(agreements) != 1)}"
    yield f"{outside} of {all_of} outside of the tolerance" if outside else f"all as expected: {all_of} compared"


def verdict(each: Agreement) -> str:
    """An output in words, without its name."""
    at = f"largest error {each.largest:.4g} {each.unit}".rstrip() + f" at {each.at_s:.9g} s"
    first = f", first at {each.first.at_s:.9g} s" if each.first else ""
    return f"{at}, allowed {each.allowed:.4g}: {_word(each)}{first}"


def to_json(title: str, outputs: Segment, agreements: Sequence[Agreement], notes: Sequence[str]) -> dict[str, Any]:
    """The same as plain data; a number that is not finite is a text."""
    return {
        "controller": title,
        "samples": len(outputs),
        "sample_time_s": outputs.dt_s,
        "outputs": [_data(each) for each in agreements],
        "notes": list(notes),
    }


def _word(each: Agreement) -> str:
    return "inside" if each.is_inside else "OUTSIDE"


def _row(each: Agreement) -> tuple[str, ...]:
    share = f"{100 * each.share:.3g} %" if each.peak > 0 else "-"
    at = f"{each.at_s:.9g} s"
    return (
        each.name,
        each.unit,
        f"{each.largest:.4g}",
        at,
        share,
        f"{each.rms:.4g}",
        f"{each.allowed:.4g}",
        _word(each),
    )


def _first(each: Agreement) -> Iterator[str]:
    if each.first is None:
        return
    k, at_s, found, expected = each.first
    yield (
        f"{each.name} differs first at {at_s:.9g} s (sample {k}): {found:.9g} where {expected:.9g} is expected;"
        f" {each.outside} of {len(each.found)} samples are outside"
    )
    if each.shifted:
        late = "late" if each.shifted > 0 else "early"
        yield f"  it is as expected but {abs(each.shifted)} sample{'s' * (abs(each.shifted) != 1)} {late}"


def _data(each: Agreement) -> dict[str, Any]:
    return {
        "name": each.name,
        "unit": each.unit,
        "compared": len(each.found),
        "largest_error": _number(each.largest),
        "at_s": each.at_s,
        "share_of_peak": _number(each.share),
        "rms_error": _number(each.rms),
        "expected_peak": each.peak,
        "allowed": each.allowed,
        "outside": each.outside,
        "first_difference": None if each.first is None else _difference(each.first),
        "late_by_samples": each.shifted,
        "status": "pass" if each.is_inside else "fail",
    }


def _difference(first: Difference) -> dict[str, Any]:
    return {name: _number(value) for name, value in first._asdict().items()}


def _number(value: float) -> float | str:
    return value if abs(value) < float("inf") else str(value)
