"""What is measured in one window: least squares over its whole cycles."""

from itertools import pairwise

import numpy as np

from recomputing.cycles import sequences, steady_frequency
from recomputing.numbers import Missing, Off, finite
from recomputing.view import View

Window = tuple[float, float]


def samples_of(view: View, window: Window) -> np.ndarray:
    """Mask of the samples of a window, its end left out."""
    tiny_s = 1e-6 * view.dt_s + 1e-9
    found = (view.t_s >= window[0] - tiny_s) & (view.t_s < window[1] - tiny_s)
    if found.sum() < 3:
        raise Missing("the record does not hold the window")
    return found


def frequency_of(view: View, window: Window) -> float:
    """The frequency before, unless the window's own is further away than the profile's threshold."""
    own = own_frequency(view, window)
    far = own is not None and abs(own - view.hz) > view.threshold("other_frequency_hz")
    return own if far and own is not None else view.hz


def own_frequency(view: View, window: Window) -> float | None:
    """Frequency of a window, of its last 0.2 s where it is longer than 3 s."""
    begin_s, end_s = window
    if end_s - begin_s > 3.0:
        begin_s = end_s - round(0.2 * view.hz) / view.hz
    here = samples_of(view, (begin_s, end_s))
    floor = view.threshold("window_voltage_floor_pu") * view.base_v
    return steady_frequency(view.abc("u")[:, here], view.dt_s, view.hz, floor)


def _whole(view: View, window: Window) -> tuple[np.ndarray, float, float]:
    """Samples of the whole cycles of its frequency, that frequency, and how long they last in samples."""
    hz = frequency_of(view, window)
    at = np.flatnonzero(samples_of(view, window))
    length = np.floor((len(at) + 1) * view.dt_s * hz + 1e-9) / (hz * view.dt_s)
    if length <= 0:
        raise Missing("the window holds no whole cycle")
    return at[: int(np.ceil(length - 1e-9))], hz, float(length)


def mean_in(view: View, x: np.ndarray, window: Window, what: str) -> float:
    """Mean over whole cycles: trapezoids, the last of which closes on the first sample."""
    at, _, length = _whole(view, window)
    y = finite(x[at], what)
    closing = length - (len(y) - 1)
    area = sum(0.5 * (a + b) for a, b in pairwise(y.tolist())) + closing * 0.5 * (y[-1] + y[0])
    return float(area / length)


def tones_in(view: View, x: np.ndarray, window: Window, order: int, what: str, line: bool = False) -> np.ndarray:
    """Phasor at a multiple of the frequency by least squares, shape of the leading axes; peak values.

    With ``line`` the least-squares straight line is taken away first.
    """
    at, hz, _ = _whole(view, window)
    y = np.atleast_2d(finite(x[..., at], what)).T
    t = view.dt_s * np.arange(len(at))
    if line:
        y = y - np.stack([np.polyval(np.polyfit(t, column, 1), t) for column in y.T], axis=1)
    angle = 2 * np.pi * order * hz * t
    found, *_ = np.linalg.lstsq(np.stack([np.cos(angle), -np.sin(angle), np.ones_like(t)], axis=1), y, rcond=None)
    phasor: np.ndarray = found[0] + 1j * found[1]
    return phasor


def voltages_in(view: View, window: Window) -> tuple[float, float]:
    """V+ and V- at the terminals (pu), looked for once."""
    if window not in view.known_voltages:
        view.known_voltages[window] = _voltages_in(view, window)
    return view.known_voltages[window]


def _voltages_in(view: View, window: Window) -> tuple[float, float]:
    positive, negative, _ = sequences(tones_in(view, view.abc("u"), window, 1, "the voltage"))
    return float(abs(positive) / view.base_v), float(abs(negative) / view.base_v)


def powers_in(view: View, window: Window) -> tuple[float, float]:
    """Mean P (kW) and Q (kvar)."""
    p, q = view.powers
    return mean_in(view, p, window, "P"), mean_in(view, q, window, "Q")


def power_before(view: View) -> float:
    """P before the disturbance, of which shares are demanded."""
    found = powers_in(view, view.before)[0]
    if found <= view.threshold("no_power_pu") * view.rated_kva:
        raise Off("there was no active power before")
    return found


def average(view: View, x: np.ndarray, window: Window, what: str) -> float:
    """Mean of a series over the samples of a window, both ends included."""
    return float(finite(x[view.between(*window)], what).mean())
