"""What a verdict needs of a record, and what is raised where it is not there."""

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.summary import Floors
from pvlvrt_compliance.profile.thresholds import Thresholds
from pvlvrt_compliance.waveforms.container import Samples


class NotApplicable(Exception):  # noqa: N818 - it is a verdict, not an error
    """Raised by a check that the code lets off in this test; the text is the reason."""


def floors_of(thresholds: Thresholds) -> Floors:
    """From where on the quantities of a window are stated."""
    return Floors(
        voltage_pu=thresholds.window_voltage_floor_pu.value,
        fundamental_pu=thresholds.least_fundamental_fraction.value,
        other_frequency_hz=thresholds.other_frequency_hz.value,
    )


def require_finite(values: Samples, what: str, t_s: Samples) -> Samples:
    """Return the values, shape (..., n), when all are finite.

    Raises
    ------
    MeasurementError
        Naming the first instant at which one is not.
    """
    finite = np.isfinite(values)
    if not finite.all():
        bad = np.atleast_2d(~finite).any(axis=0)
        raise MeasurementError(f"{what} has no finite value at {t_s[bad.argmax()]:.3f} s")
    return values


def required(value: float | None, what: str) -> float:
    """Return a measured value that a verdict needs.

    Raises
    ------
    MeasurementError
        When it could not be measured.
    """
    if value is None:
        raise MeasurementError(f"{what} could not be measured")
    return value
