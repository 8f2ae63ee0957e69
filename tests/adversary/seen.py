"""A record as the sentences see it: numpy alone, nothing of the package."""

from typing import NamedTuple

import numpy as np

S_KVA = 500.0
I_PEAK_A = 1000 * S_KVA / 3 / 230 * np.sqrt(2)


class Level(NamedTuple):
    """What the grid does from one step to the next."""

    begin_s: float
    end_s: float
    v_positive: float  # pu
    v_negative: float
    v_lowest: float  # lowest phase

    @property
    def normal(self) -> bool:
        return 0.9 <= self.v_positive <= 1.1 and self.v_negative <= 0.1

    @property
    def lasts_s(self) -> float:
        return self.end_s - self.begin_s


class Record(NamedTuple):
    """Voltages and currents of the phases, shape (3, n), and what follows from them over a cycle."""

    t_s: np.ndarray
    current_pu: np.ndarray
    closed: np.ndarray
    v_dc: np.ndarray
    p_kw: np.ndarray  # of the instant
    q_kvar: np.ndarray
    p_cycle: np.ndarray  # mean over the cycle that ends here
    q_cycle: np.ndarray
    p_half: np.ndarray  # over half of one
    q_half: np.ndarray
    phases_pu: np.ndarray  # fundamentals of the three currents over a cycle, amplitudes
    i_active: np.ndarray  # of the positive sequence, pu
    i_reactive: np.ndarray
    cycle_s: float

    def between(self, begin_s: float, end_s: float) -> np.ndarray:
        return (self.t_s >= begin_s) & (self.t_s < end_s)


def sliding(t_s: np.ndarray, x: np.ndarray, span_s: float) -> np.ndarray:
    """Mean over the span that ends at each instant; not a number before there is one. Shape of ``x`` (..., n)."""
    steps = 0.5 * (x[..., 1:] + x[..., :-1]) * np.diff(t_s)
    total = np.concatenate([np.zeros((*x.shape[:-1], 1), steps.dtype), np.cumsum(steps, axis=-1)], axis=-1)
    dt = t_s[1] - t_s[0]
    place = (t_s - span_s - t_s[0]) / dt
    low = np.clip(np.floor(place).astype(int), 0, len(t_s) - 2)
    share = place - low
    before = total[..., low] * (1 - share) + total[..., low + 1] * share
    mean = (total - before) / span_s
    mean[..., place < 0] = np.nan
    return mean


def record_of(columns: dict[str, np.ndarray], t_s: np.ndarray, frequency_hz: float) -> Record:
    """Everything that the sentences need."""
    u = np.stack([columns[f"u_{name}_v"] for name in "abc"])
    i = np.stack([columns[f"i_{name}_a"] for name in "abc"])
    p = (u * i).sum(axis=0) / 1e3
    q = ((u[1] - u[2]) * i[0] + (u[2] - u[0]) * i[1] + (u[0] - u[1]) * i[2]) / np.sqrt(3) / 1e3
    cycle_s = 1 / frequency_hz
    turn = np.exp(-2j * np.pi * frequency_hz * t_s)
    phasors_i = 2 * sliding(t_s, i * turn, cycle_s)
    phasors_u = 2 * sliding(t_s, u * turn, cycle_s)
    a = np.exp(2j * np.pi / 3)
    i_positive = (phasors_i[0] + a * phasors_i[1] + a**2 * phasors_i[2]) / 3
    u_positive = (phasors_u[0] + a * phasors_u[1] + a**2 * phasors_u[2]) / 3
    with np.errstate(invalid="ignore"):  # before the first cycle, and without a voltage
        along = i_positive * np.conj(u_positive) / np.abs(u_positive)
    half = cycle_s / 2
    return Record(
        t_s=t_s,
        current_pu=i / I_PEAK_A,
        closed=columns["connected"] > 0.5,
        v_dc=columns["v_dc_v"],
        p_kw=p,
        q_kvar=q,
        p_cycle=sliding(t_s, p, cycle_s),
        q_cycle=sliding(t_s, q, cycle_s),
        p_half=sliding(t_s, p, half),
        q_half=sliding(t_s, q, half),
        phases_pu=np.abs(phasors_i) / I_PEAK_A,
        i_active=along.real / I_PEAK_A,
        i_reactive=-along.imag / I_PEAK_A,
        cycle_s=cycle_s,
    )


def power_before(record: Record, levels: list[Level]) -> tuple[float, float]:
    """Mean P (kW) and Q (kvar) of ten cycles that end a cycle before the first step."""
    end_s = levels[0].begin_s - record.cycle_s
    inside = record.between(end_s - 10 * record.cycle_s, end_s)
    return float(record.p_kw[inside].mean()), float(record.q_kvar[inside].mean())


def longest_run(mask: np.ndarray, t_s: np.ndarray) -> float:
    """Longest time that a mask is true for without a break (s)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    begins, ends = edges[::2], edges[1::2] - 1
    return float((t_s[ends] - t_s[begins]).max()) if len(begins) else 0.0


def settled_mean(record: Record, level: Level, x: np.ndarray) -> float | None:
    """Mean over whole cycles from 100 ms after the step on; None where none fits before 20 ms to the end."""
    begin_s, end_s = level.begin_s + 0.1, level.end_s - 0.02
    cycles = int((end_s - begin_s) / record.cycle_s + 1e-6)
    if cycles < 1:
        return None
    return float(x[record.between(end_s - cycles * record.cycle_s, end_s)].mean())
