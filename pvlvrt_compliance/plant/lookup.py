"""Places in tables whose rows are in order of time."""

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel


@kernel
def count_until(t: float, instants: NDArray[np.float64]) -> int:
    """How many instants (s), in order of time, are not after ``t``: in few steps, however many there are."""
    low, high = 0, len(instants)
    while low < high:
        middle = (low + high) // 2
        if instants[middle] <= t:
            low = middle + 1
        else:
            high = middle
    return low
