"""Single blocks of the loop that are wrong: of the plant, and of a controller in either precision."""

import math
from collections.abc import Callable
from typing import Any

from pvlvrt_compliance.control.lvrt import LvrtOrder, LvrtParams, lvrt_step
from pvlvrt_compliance.plant.grid import Source
from pvlvrt_compliance.plant.plant import PlantParams, PlantState, PlantTables, advance, plant_step


def no_reactive_support(u_pos: complex, u_neg: complex, p: LvrtParams) -> LvrtOrder:
    """Give all of S_fault to active power."""
    right = lvrt_step(u_pos, u_neg, p)
    P_limit = math.hypot(right.P_limit, right.Q_ref)
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P_limit, Q_ref=0.0)


def bridge_blocked(x: PlantState, m: complex, e: complex, u_min: float, p: PlantParams) -> PlantState:
    """Block the bridge at the first low voltage, for good, with the breaker left closed."""
    after = plant_step(x, m, e, u_min, p)
    return PlantState(
        i=after.i,
        v_dc=after.v_dc,
        x_pv=after.x_pv,
        i_pv=after.i_pv,
        relay=after.relay,
        trip=after.trip,
        t_trip=after.t_trip,
        closed=after.closed,
        blocked=after.blocked or after.relay.t_low > 0,
        mean=after.mean,
    )


def not_a_number(
    x: PlantState, m: complex, source: Source, t: float, p: PlantParams, tables: PlantTables
) -> PlantState:
    """Lose the DC voltage from 0.5 s on."""
    after = advance(x, m, source, t, p, tables)
    return PlantState(
        i=after.i,
        v_dc=after.v_dc if t < 0.5 else math.nan,
        x_pv=after.x_pv,
        i_pv=after.i_pv,
        relay=after.relay,
        trip=after.trip,
        t_trip=after.t_trip,
        closed=after.closed,
        blocked=after.blocked,
        mean=after.mean,
    )


WRONG_PARTS: dict[str, dict[str, Callable[..., Any]]] = {
    "no_reactive_support": {"lvrt_step": no_reactive_support},
    "bridge_blocked": {"plant_step": bridge_blocked},
    "not_a_number": {"advance": not_a_number},
}
"""Replacements for `rebuild.rebuilt_loop`, by what is wrong."""
