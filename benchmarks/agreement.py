"""How far two records of the same run are apart."""

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.simulation.columns import CHANNELS
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import unit_of

TOLERANCE = 1e-6
"""Largest difference of two waveforms, of nominal."""


def scale_of(channel: str, nominal: Nominal) -> float:
    """What one nominal is in the unit of a channel; 1 where there is no nominal."""
    if channel in {"v_dc_v", "v_dc_ref_v"}:
        return 1000.0
    rated = nominal.apparent_power_va
    by_unit = {"V": nominal.phase_voltage_peak_v, "A": nominal.phase_current_peak_a, "W": rated, "var": rated}
    return by_unit.get(unit_of(channel), 1.0)


def differences(mine: NDArray[np.float64], theirs: NDArray[np.float64]) -> dict[str, float]:
    """Largest difference of two records in every channel, of nominal; infinite where a number is missing."""
    nominal = Nominal()
    apart = np.nan_to_num(np.abs(mine - theirs).max(axis=0), nan=np.inf)
    return {name: float(x) / scale_of(name, nominal) for name, x in zip(CHANNELS, apart, strict=True)}
