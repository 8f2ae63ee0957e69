"""Means and phasors of the cycle that ends at each sample, by direct sums; frequency from their turning."""

import numpy as np
from scipy.signal import oaconvolve

A = np.exp(2j * np.pi / 3)


def window_weights(samples: float) -> np.ndarray:
    """Weights of the mean over a window that ends at a sample and is some samples long, the latest first.

    Straight lines between the samples; the far end lies between two of them.
    """
    whole = int(np.floor(samples + 1e-9))
    part = max(samples - whole, 0.0)
    weights = np.ones(whole + 1)
    weights[0] = weights[-1] = 0.5
    if part > 1e-9:
        weights[-1] += part * (2 - part) / 2
        weights = np.append(weights, part * part / 2)
    return weights / samples


def mean_of_cycle(x: np.ndarray, samples: float | np.ndarray) -> np.ndarray:
    """Mean over the window of that many samples which ends at each sample, last axis; not a number before it is full.

    With a window length at each sample, each mean is a sum of its own.
    """
    n = x.shape[-1]
    if np.ndim(samples) == 0:
        weights = window_weights(float(samples))
        found = oaconvolve(x, np.broadcast_to(weights, (*x.shape[:-1], len(weights))), axes=-1)[..., :n]
        found[..., : int(np.ceil(float(samples) - 1e-9)) + 1] = np.nan
        return found
    return _mean_of_own_cycles(x, samples)


def _mean_of_own_cycles(x: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """With a length at each sample: the area under the straight lines up to now, less that up to then."""
    n = x.shape[-1]
    area = np.concatenate([np.zeros((*x.shape[:-1], 1)), np.cumsum(0.5 * (x[..., 1:] + x[..., :-1]), axis=-1)], axis=-1)
    then = np.arange(n) - samples
    known = then >= 0
    k = np.minimum(np.maximum(np.floor(then), 0).astype(int), n - 2)
    part = np.where(known, then - k, 0.0)
    past = area[..., k] + part * x[..., k] + 0.5 * part**2 * (x[..., k + 1] - x[..., k])
    return np.where(known, (area - past) / samples, np.nan)


def turned_rad(hz: float | np.ndarray, n: int, dt_s: float) -> np.ndarray:
    """Angle that a frequency has turned by since the first sample."""
    if np.ndim(hz) == 0:
        return 2 * np.pi * float(hz) * dt_s * np.arange(n)
    steps = 0.5 * (hz[1:] + hz[:-1])
    return 2 * np.pi * dt_s * np.concatenate([[0.0], np.cumsum(steps)])


def phasors(x: np.ndarray, hz: float | np.ndarray, dt_s: float) -> np.ndarray:
    """X(t) = (2/T) integral of x e^(-j theta) over the cycle that ends at t; peak values."""
    angle = turned_rad(hz, x.shape[-1], dt_s)
    return 2 * mean_of_cycle(x * np.exp(-1j * angle), 1 / (np.asarray(hz) * dt_s))


def sequences(abc: np.ndarray) -> np.ndarray:
    """Positive, negative and zero sequence of three phasors, along the first axis."""
    a, b, c = abc
    return np.array([a + A * b + A * A * c, a + A * A * b + A * c, a + b + c]) / 3


def positive_vector(abc: np.ndarray) -> np.ndarray:
    """(a + A b + A^2 c)/3 of the samples, whose part at +f is half of the positive sequence's phasor."""
    return sequences(abc)[0]


def steady_frequency(abc: np.ndarray, dt_s: float, nominal_hz: float, floor: float) -> float | None:
    """The frequency at which U+ stands still, by the slope of its angle; None where there is none."""
    hz = nominal_hz
    for _ in range(30):
        z = phasors(positive_vector(abc), hz, dt_s)
        z = z[np.isfinite(z)]
        if len(z) < 0.45 / (hz * dt_s) or np.abs(z).min() < floor:
            return None
        slope = np.polyfit(dt_s * np.arange(len(z)), np.unwrap(np.angle(z)), 1)[0] / (2 * np.pi)
        hz += float(slope)
        if abs(hz - nominal_hz) > 0.5 * nominal_hz:
            return None
        if abs(slope) < 1e-7:
            return hz
    return None


def held(x: np.ndarray, before: float) -> np.ndarray:
    """The last number at each sample."""
    found, last = np.empty(len(x)), before
    for k, value in enumerate(x.tolist()):
        last = value if value == value else last  # noqa: PLR0124 - not a number is not itself
        found[k] = last
    return found


def tracked_frequency(abc: np.ndarray, dt_s: float, nominal_hz: float, floor: float) -> np.ndarray:
    """f(t) = (angle(t) - angle(t - T)) / (2 pi T) of U+, its cycle counted by what was found before, three times."""
    n = abc.shape[-1]
    vector, assumed = positive_vector(abc), np.full(n, nominal_hz)
    since = 0
    for turn in range(3):
        hz = nominal_hz if turn == 0 else assumed
        z = phasors(vector, hz, dt_s)
        cycle = 1 / (assumed * dt_s)
        more = mean_of_cycle(turned_rad(assumed - nominal_hz, n, dt_s), cycle if turn else cycle[0])
        ago = np.maximum(np.arange(n) - np.rint(cycle).astype(int), 0)
        middle_s = dt_s * (np.arange(n) - 0.5 * cycle)
        angle = np.angle(z * np.conj(z[ago])) + more - more[ago]
        with np.errstate(invalid="ignore", divide="ignore"):
            found = nominal_hz + angle / (2 * np.pi * (middle_s - middle_s[ago]))
            found[~(np.minimum(np.abs(z), np.abs(z[ago])) >= floor)] = np.nan
        known = np.flatnonzero(np.isfinite(found))
        if not len(known):
            return np.full(n, np.nan)
        since = max(since, int(known[0]))
        assumed = np.clip(held(found, float(found[known[0]])), 0.75 * nominal_hz, 1.25 * nominal_hz)
    assumed[:since] = np.nan
    return assumed


def steering_frequency(tracked: np.ndarray, dt_s: float, nominal_hz: float) -> np.ndarray:
    """Median of the last five cycles of a tracked frequency, refreshed sixteen times a cycle, held in between."""
    known = np.flatnonzero(np.isfinite(tracked))
    x = held(tracked, float(tracked[known[0]]) if len(known) else nominal_hz)
    stride = max(int(1 / (nominal_hz * dt_s) / 16), 1)
    found = np.empty(len(x))
    for k in range(0, len(x), stride):
        last = x[max(k - 79 * stride, k % stride) : k + 1 : stride]
        last = np.concatenate([np.full(80 - len(last), x[0]), last])
        found[k : k + stride] = np.median(last)
    return found
