"""How long the active power takes to come back."""

import numpy as np

from pvlvrt_compliance.checks.evidence import Evidence, require_finite


def recovered_after_s(evidence: Evidence, from_s: float, target_kw: float) -> float | None:
    """Time from an instant until the one-cycle mean of P stays at or above a power.

    Parameters
    ----------
    evidence : Evidence
        The record.
    from_s : float
        The instant that the time counts from (s, from the start of the record).
    target_kw : float
        The power (kW).

    Returns
    -------
    float or None
        Seconds; 0 when P is never below the power from the instant on, None when the record ends below it.

    Raises
    ------
    MeasurementError
        When P is not finite somewhere from the instant on.
    """
    after = evidence.between(from_s, evidence.waveforms.end_s)
    t_s = evidence.t_s[after]
    active_power = require_finite(evidence.active_power_kw[after], "P", t_s)
    too_low = np.flatnonzero(active_power < target_kw)
    if not len(too_low):
        return 0.0
    return float(t_s[too_low[-1] + 1] - from_s) if too_low[-1] + 1 < len(t_s) else None
