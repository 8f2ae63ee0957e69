"""Quality of the current over ten or twelve cycles of steady operation."""

from typing import NamedTuple

import numpy as np

from recomputing.numbers import Missing, Recomputed, Table, at_most, finite, nearest_part, number
from recomputing.view import View
from recomputing.windows import Window, own_frequency, samples_of


class Steady(NamedTuple):
    """One window, in units of the rated current's rms."""

    begin_s: float
    hz: float
    current: np.ndarray
    length: float  # of whole cycles, in samples


def steady_windows(view: View) -> list[Steady]:
    """The cycles before the disturbance, and unless it tripped those at the end."""
    ends = [view.before]
    if view.after is not None and view.opened_s is None:
        ends.append(view.after)
    return [_steady(view, window) for window in ends]


def _steady(view: View, window: Window) -> Steady:
    cycles = round(0.2 * view.nominal_hz)
    hz = own_frequency(view, window) or view.hz
    begin_s = window[1] - cycles / hz
    if begin_s < view.t_s[0] - 1e-3:
        raise Missing("the window leaves the record")
    current = finite(view.abc("i")[:, samples_of(view, (begin_s, window[1]))], "the current")
    return Steady(begin_s, hz, current / (view.base_a / np.sqrt(2)), cycles / (hz * view.dt_s))


def _weights(n: int, length: float) -> np.ndarray:
    """Of the mean over a periodic signal: trapezoids, the last one closes on the first sample."""
    weights = np.ones(n)
    weights[[0, -1]] = 0.5 + 0.5 * (length - (n - 1))
    return weights / length


def _lines(view: View, steady: Steady, highest: int) -> np.ndarray:
    """Rms of each line k f/N: the fundamental by least squares, the others by sums over what it leaves."""
    n = min(steady.current.shape[1], int(np.ceil(steady.length - 1e-9)))
    y, t = steady.current[:, :n], view.dt_s * np.arange(n)
    cycles = round(0.2 * view.nominal_hz)
    first = np.stack([np.cos(2 * np.pi * steady.hz * t), np.sin(2 * np.pi * steady.hz * t), np.ones(n)], axis=1)
    found, *_ = np.linalg.lstsq(first, y.T, rcond=None)
    rest = y - (first @ found).T
    weights = _weights(n, steady.length)
    k = np.arange(highest)
    kernel = np.exp(-2j * np.pi * steady.hz / cycles * np.outer(k, t)) * weights
    lines = np.sqrt(2) * np.abs(rest @ kernel.T)
    lines[:, 0] = np.abs(found[2])
    lines[:, cycles] = np.hypot(found[0], found[1]) / np.sqrt(2)
    return lines


def judge_harmonics(view: View, demand: Table) -> Recomputed:
    """Subgroups by order, TRD and THD; the limit nearest to failing."""
    parts = []
    for steady in steady_windows(view):
        cycles = round(0.2 * view.nominal_hz)
        lines = _lines(view, steady, 51 * cycles)
        sizes = [np.zeros(3)]
        for order in range(1, 51):
            k = order * cycles
            sizes.append(np.sqrt(lines[:, k - 1] ** 2 + lines[:, k] ** 2 + lines[:, k + 1] ** 2))
        groups = np.array(sizes)
        for order in range(2, 51):
            limit = _limit_of(demand.get("orders"), order)
            if limit is not None:
                parts.append(at_most("harmonics", 100 * float(groups[order].max()), limit, steady.begin_s, "%"))
        if number(demand, "total_percent") is not None:
            total = 100 * float(_distortion(view, steady).max())
            parts.append(at_most("harmonics", total, number(demand, "total_percent"), steady.begin_s, "%"))
        if number(demand, "thd_percent") is not None:
            if groups[1].min() < view.threshold("least_fundamental_fraction"):
                raise Missing("there is no fundamental")
            thd = 100 * float((np.sqrt((groups[2:41] ** 2).sum(axis=0)) / groups[1]).max())
            parts.append(at_most("harmonics", thd, number(demand, "thd_percent"), steady.begin_s, "%"))
    return nearest_part(parts)


def _limit_of(table: Table | None, order: int) -> float | None:
    for row in [] if table is None else table["rows"]:
        which = row.get("which", "all")
        odd = order % 2 == 1
        if row["orders"][0] <= order <= row["orders"][1] and (which == "all" or odd == (which == "odd")):
            return float(row["limit_percent"])
    return None


def _distortion(view: View, steady: Steady) -> np.ndarray:
    """Rms of all but the fundamental, over the rated current."""
    n = min(steady.current.shape[1], int(np.ceil(steady.length - 1e-9)))
    y, angle = steady.current[:, :n], 2 * np.pi * steady.hz * view.dt_s * np.arange(n)
    found, *_ = np.linalg.lstsq(np.stack([np.cos(angle), np.sin(angle), np.ones(n)], axis=1), y.T, rcond=None)
    rest = y - np.stack([np.cos(angle), np.sin(angle)], axis=1).dot(found[:2]).T
    size: np.ndarray = np.sqrt((rest**2) @ _weights(n, steady.length))
    return size


def judge_dc(view: View, demand: Table) -> Recomputed:
    """Largest mean of a phase current before the disturbance, in percent of the rated rms."""
    steady = steady_windows(view)[0]
    n = min(steady.current.shape[1], int(np.ceil(steady.length - 1e-9)))
    size = 100 * float(np.abs(steady.current[:, :n] @ _weights(n, steady.length)).max())
    return at_most("dc_injection", size, number(demand, "limit_percent"), steady.begin_s, "%")
