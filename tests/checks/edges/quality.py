"""Edges of what a current and a DC voltage may hold besides."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from edges.edge import FAIL, FINE_STEP_S, PASS, RATED_KVA, SHARE, Edge, hz, record
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.requirements import (
    DcInjection,
    DcRipple,
    Harmonics,
)
from pvlvrt_compliance.profile.tables import HarmonicLimit
from pvlvrt_compliance.scenario.sag import Sag


def dc_ripple(demand: DcRipple, profile: Profile) -> Iterator[Edge]:
    """An amplitude in percent of the mean; the bench's v_DC rises besides."""
    assert profile
    limit = demand.limit_percent.value
    sides = ((PASS, limit * (1 - SHARE)), (FAIL, limit * (1 + SHARE)))
    yield Edge(
        "ripple of v_DC",
        ("limit_percent",),
        *(record(s, Sag(depth=0.5), dc_ripple_percent=x, q_sag_kvar=200.0, dt_s=FINE_STEP_S) for s, x in sides),
    )


def harmonics(demand: Harmonics, profile: Profile) -> Iterator[Edge]:
    """The first and the last order of each row, of those it is for; the totals by the fifth harmonic."""
    nominal_hz = hz(profile)
    if demand.orders is not None:
        rows = demand.orders.rows
        for row in rows:
            orders = [
                n
                for n in range(row.orders[0], row.orders[1] + 1)
                if demand.orders.limit_of(n) == row.limit_percent and _is_for(row, n)
            ]
            for order in {orders[0], orders[-1]}:
                yield _tone(
                    f"order {order}", ("orders",), order, row.limit_percent, nominal_hz, {"total_percent": None}
                )
    for name in ("total_percent", "thd_percent"):
        if (number := getattr(demand, name)) is not None:
            others = {"orders": None, "thd_percent": None, "total_percent": None}
            others.pop(name)
            yield _tone(name, (name,), 5, number.value, nominal_hz, others)


def _is_for(row: HarmonicLimit, order: int) -> bool:
    return row.which == "all" or (order % 2 == 1) == (row.which == "odd")


def _tone(
    label: str, names: tuple[str, ...], order: int, percent: float, nominal_hz: float, only: dict[str, Any]
) -> Edge:
    """A harmonic of one phase beside the rated current, so that both percentages are the same."""

    def extra(size: float) -> Any:
        def current(t: np.ndarray) -> np.ndarray:
            tone = 0.01 * size * np.cos(2 * np.pi * order * nominal_hz * t + 0.4)
            return np.stack([tone, 0 * t, 0 * t])

        return current

    sides = ((PASS, percent * (1 - 5 * SHARE)), (FAIL, percent * (1 + 5 * SHARE)))
    return Edge(
        label,
        names,
        *(record(s, p_sag_kw=RATED_KVA, extra_current_pu=extra(x), dt_s=FINE_STEP_S) for s, x in sides),
        only,
    )


def dc_injection(demand: DcInjection, profile: Profile) -> Iterator[Edge]:
    """Direct current in one phase, of either sign, in percent of the rated current's rms."""
    assert profile
    limit = demand.limit_percent.value / 100 / math.sqrt(2)

    def direct(size: float) -> Any:
        return lambda t: np.stack([0 * t, size + 0 * t, 0 * t])

    for sign in (-1, 1):
        sides = ((PASS, sign * limit * (1 - SHARE)), (FAIL, sign * limit * (1 + SHARE)))
        yield Edge(
            f"direct current, {sign:+d}",
            ("limit_percent",),
            *(record(s, p_sag_kw=RATED_KVA, extra_current_pu=direct(x)) for s, x in sides),
        )
