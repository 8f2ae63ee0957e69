"""Irradiance over time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.lookup import count_until


class IrradianceTable(NamedTuple):
    """Points joined by straight lines, the first before the run; the last level is held."""

    t: NDArray[np.float64]  # (s)
    G: NDArray[np.float64]  # in units of 1000 W/m2 (-)


@kernel
def irradiance_at(t: float, table: IrradianceTable) -> float:
    """Irradiance at an instant, in units of 1000 W/m2."""
    k = max(count_until(t, table.t), 1)
    G: float = table.G[len(table.G) - 1]
    if k < len(table.t):
        share = (t - table.t[k - 1]) / (table.t[k] - table.t[k - 1])
        G = table.G[k - 1] + share * (table.G[k] - table.G[k - 1])
    return G
