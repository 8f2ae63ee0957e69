"""What every part of the program shares: numbers of a profile, verdicts, reasons not to judge."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

Table = dict[str, Any]


class Off(Exception):  # noqa: N818 - a verdict, not an error
    """Nothing is demanded: `not_applicable`."""


class Missing(Exception):  # noqa: N818 - a verdict, not an error
    """Something cannot be measured: `not_evaluated`."""


class Recomputed(NamedTuple):
    """One verdict."""

    check: str
    status: str
    measured: float | None = None
    limit: float | None = None
    margin: float | None = None
    at_s: float | None = None
    unit: str = ""


def number(table: Table | None, key: str, default: float | None = None) -> Any:
    """Value of a marked number of a profile, the default where it is not stated."""
    found = None if table is None else table.get(key)
    if found is None:
        return default
    return found["value"] if isinstance(found, dict) else found


def at_least(check: str, measured: float, limit: float, at_s: float, unit: str, tolerance: float = 0.0) -> Recomputed:
    """Verdict on a value that may be a limit at least, less a tolerance."""
    margin = measured - (limit - tolerance)
    return Recomputed(check, "pass" if margin >= 0 else "fail", measured, limit, margin, at_s, unit)


def at_most(check: str, measured: float, limit: float, at_s: float, unit: str) -> Recomputed:
    """Verdict on a value that may be a limit at most; rounding where both are zero is none."""
    margin = limit - measured
    return Recomputed(check, "pass" if margin >= -0.5e-9 else "fail", measured, limit, margin, at_s, unit)


def worst_of(verdicts: Sequence[Recomputed]) -> Recomputed:
    """A failed one first, then the least margin; a failure without a margin is the worst of all."""

    def rank(verdict: Recomputed) -> tuple[bool, float]:
        none = -np.inf if verdict.status == "fail" else np.inf
        return verdict.status != "fail", none if verdict.margin is None else verdict.margin

    return min(verdicts, key=rank)


def nearest_part(parts: Sequence[Recomputed], relative: bool = True) -> Recomputed:
    """Of several limits the one that failed, then the one with the least margin, in shares of its limit or not."""
    if not parts:
        raise Off("no limit")

    def rank(part: Recomputed) -> tuple[bool, float]:
        margin = 0.0 if part.margin is None else part.margin
        if not relative:
            return part.status == "pass", margin
        limit = part.limit or 0.0
        return part.status == "pass", margin / limit if limit > 0 else np.inf if margin >= 0 else -np.inf

    return min(parts, key=rank)


def finite(values: np.ndarray, what: str) -> np.ndarray:
    """The values, where all are numbers."""
    if not np.isfinite(values).all():
        raise Missing(f"{what} is not known everywhere")
    return values


def runs_of(mask: np.ndarray) -> list[tuple[int, int]]:
    """First sample and first sample after it of each run of a mask, by walking along it."""
    found, begun = [], None
    for k, inside in enumerate(mask.tolist()):
        if inside and begun is None:
            begun = k
        if not inside and begun is not None:
            found.append((begun, k))
            begun = None
    return found if begun is None else [*found, (begun, len(mask))]
