"""How far two verdicts on one thing are apart."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from recomputing.numbers import Recomputed

SHARE = 1e-3
FLOORS = {"s": 5e-5, "pu": 1e-5, "kW": 0.01, "kvar": 0.01, "kW s": 1e-4, "kvar s": 1e-4, "%": 2e-4, "": 1e-4}
"""Least distance that counts, by unit: a sample for times, a twentieth of what rounding in a file leaves else."""

OF_SEVERAL = ("harmonics", "consumption", "support_dynamics", "active_power_recovery")
"""Checks that report the limit with the least margin in shares of it."""

ONE_WAY_KVA = 0.25
"""Of a power that jumps and then goes one way, a cubic and a straight line leave different remainders of the jump."""


def read_csv(path: Path) -> dict[str, np.ndarray]:
    """Channels of a CSV file by name."""
    with path.open(encoding="ascii") as file:
        names = file.readline().strip().split(",")
        table = np.loadtxt(file, delimiter=",", ndmin=2)
    return dict(zip(names, table.T, strict=True))


def read_results(folder: Path) -> dict[str, Any]:
    """`results.json` of a run."""
    found: dict[str, Any] = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    return found


def differences(told: dict[str, Any], found: Recomputed) -> list[str]:
    """What of one verdict is not what was recomputed; empty where all is."""
    if told["status"] != found.status:
        return [f"{found.check}: told {told['status']} ({told['message']}), recomputed {found}"]
    sizes = [abs(x) for x in (told["limit"], told["measured"]) if x is not None]
    if _equally_near(told, found):
        return []
    allowed = max([SHARE * max(sizes, default=0.0), FLOORS.get(told["unit"], 0.0)])
    if _one_way_only(told, found):
        allowed = max(allowed, ONE_WAY_KVA)
    different = []
    for name in ("measured", "limit", "margin"):
        a, b = told[name], getattr(found, name)
        if (a is None) != (b is None) or (a is not None and abs(a - b) > allowed):
            different.append(f"{found.check}: {name} told {a}, recomputed {b} {told['unit']} ({told['message']})")
    apart = told["unit"] != found.unit and told["measured"] is not None and max(sizes[1:], default=0.0) > allowed
    if not different and apart and told["check"] != "oscillation":  # where P and Q swing equally, either may be told
        different.append(f"{found.check}: unit told {told['unit']}, recomputed {found.unit}")
    return different


def _one_way_only(told: dict[str, Any], found: Recomputed) -> bool:
    """Whether next to nothing of a swing is left: less than a twentieth of its limit, by both."""
    sizes = (told["measured"], found.measured)
    return told["check"] == "oscillation" and all(x is not None and 20 * x < (found.limit or 0.0) for x in sizes)


def _equally_near(told: dict[str, Any], found: Recomputed) -> bool:
    """Whether of several limits, all kept, two lie equally near: either of them is then the right one to report."""
    if told["check"] not in OF_SEVERAL or not told["limit"] or not found.limit:
        return False
    return abs(told["margin"] / told["limit"] - found.margin / found.limit) <= SHARE
