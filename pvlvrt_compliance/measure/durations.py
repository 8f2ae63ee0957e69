"""Statistics over time, where samples stand for steps of different length."""

import numpy as np

from pvlvrt_compliance.waveforms.container import Samples


def mean_over_time(x: Samples, step_s: Samples) -> float:
    """Mean of a signal over time, in its unit.

    Parameters
    ----------
    x, step_s : array, shape (n,)
        As of `median_over_time`.
    """
    if is_one_step(step_s):
        return float(np.add.reduce(x) / len(x))
    return float(np.einsum("n,n->", x, step_s) / step_s.sum())


def is_one_step(step_s: Samples) -> bool:
    """Whether all samples are known, without a look at them, to stand for as long as the first: one number for all."""
    return step_s.strides == (0,)


def median_over_time(x: Samples, step_s: Samples) -> float:
    """Value below which a signal is for half of the time.

    Parameters
    ----------
    x : array, shape (n,)
        Signal, finite, n at least 1.
    step_s : array, shape (n,)
        Time that each sample stands for (s).
    """
    if is_one_step(step_s) or (step_s == step_s[0]).all():  # then the place is the same in any order
        lasting_s = np.cumsum(step_s)
        middle = int(np.searchsorted(lasting_s, 0.5 * lasting_s[-1]))
        return float(np.partition(x, middle)[middle])
    order = np.argsort(x)
    lasting_s = np.cumsum(step_s[order])
    return float(x[order[np.searchsorted(lasting_s, 0.5 * lasting_s[-1])]])
