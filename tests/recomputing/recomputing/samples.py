"""A record on one even grid of samples."""

import numpy as np
from scipy.interpolate import CubicSpline

SAME_S = 2e-9  # what a file rounds its instants by, and a little


def even(waveforms: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The record on the grid of its finest step; where it is coarser, in between by smooth lines."""
    t_s = np.asarray(waveforms["t_s"], dtype=float)
    steps = np.diff(t_s)
    n = round((t_s[-1] - t_s[0]) / steps[steps < 1.5 * steps.min()].mean()) + 1
    even = np.linspace(t_s[0], t_s[-1], n)
    if n == len(t_s):
        return {**{name: np.asarray(x, dtype=float) for name, x in waveforms.items()}, "t_s": even}
    held = np.clip(np.searchsorted(t_s, even + SAME_S, side="right") - 1, 0, len(t_s) - 1)
    made = {"t_s": even}
    for name, x in waveforms.items():
        if name != "t_s":
            made[name] = x[held] if name in ("connected", "trip_cause") else CubicSpline(t_s, x)(even)
    return made
