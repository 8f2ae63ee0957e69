"""Limits of a check as a figure draws them, made in one way."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import TypeVar

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import NotApplicable
from pvlvrt_compliance.evidence.excursions import runs_of
from pvlvrt_compliance.evidence.outline import bends
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.results import Band, Drawn
from pvlvrt_compliance.waveforms.container import Samples

_FINE = 1e-3  # part of the largest value: how far a limit that is drawn may be from one that changes all along

Part = TypeVar("Part")
Kind = TypeVar("Kind", bound=Drawn)


def of_each(parts: Iterable[Part], drawn: Callable[[Part], Iterable[Kind]]) -> tuple[Kind, ...]:
    """What is drawn of those parts of a record that can be judged."""
    found: list[Kind] = []
    for part in parts:
        with suppress(NotApplicable, MeasurementError):
            found += drawn(part)
    return tuple(found)


def level(
    check: str,
    quantity: str,
    name: str,
    span: Sequence[float],
    *,
    lower: float | None = None,
    upper: float | None = None,
    widened: bool = False,
) -> Band:
    """A limit that holds from one instant to another (s); parameters as of `Band`."""
    return Band(
        check=check,
        quantity=quantity,
        name=name,
        t_s=tuple(span),
        lower=None if lower is None else (lower,) * len(span),
        upper=None if upper is None else (upper,) * len(span),
        widened=widened,
    )


def around(
    check: str, quantity: str, name: str, span: Sequence[float], middle: float, room: float, *, widened: bool = False
) -> Band:
    """A limit on both sides of a value."""
    return level(check, quantity, name, span, lower=middle - room, upper=middle + room, widened=widened)


def along(
    check: str,
    quantity: str,
    name: str,
    t_s: Samples,
    *,
    lower: Samples | None = None,
    upper: Samples | None = None,
    widened: bool = False,
) -> Band:
    """A limit that changes all along, by as few points as its straight lines need.

    Parameters
    ----------
    t_s : array, shape (n,)
        Instants (s), one at least.
    lower, upper : array, shape (n,)
        The limit there; finite.
    """
    edges = [edge for edge in (lower, upper) if edge is not None]
    fine = _FINE * max(float(np.abs(edge).max()) for edge in edges)
    kept = bends(fine, t_s, *edges)
    return Band(
        check=check,
        quantity=quantity,
        name=name,
        t_s=tuple(t_s[kept].tolist()),
        lower=None if lower is None else tuple(lower[kept].tolist()),
        upper=None if upper is None else tuple(upper[kept].tolist()),
        widened=widened,
    )


def about_the_line(
    check: str,
    quantity: str,
    name: str,
    span: tuple[float, float],
    ends: tuple[float, float],
    room: float,
    *,
    half_cycle: bool = False,
) -> Band:
    """What a series may swing by about its straight line: so wide in all, in the middle of where it swings.

    ``ends`` are the values of that middle at the instants of the span, as `measure.swing.Swing` has them.
    """
    return Band(
        check=check,
        quantity=quantity,
        name=name,
        t_s=span,
        lower=tuple(end - room / 2 for end in ends),
        upper=tuple(end + room / 2 for end in ends),
        about_its_line=True,
        half_cycle=half_cycle,
    )


def stretches_of(mask: Mask) -> Iterator[slice]:
    """Stretches of samples that a mask holds without a break."""
    yield from (slice(first, end) for first, end in runs_of(mask))
