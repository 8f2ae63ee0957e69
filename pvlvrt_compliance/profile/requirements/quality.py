"""Quality of what the inverter feeds, before and after a sag, and of its DC voltage."""

from pydantic import Field

from pvlvrt_compliance.data.marks import Positive
from pvlvrt_compliance.profile.requirements.base import Requirement
from pvlvrt_compliance.profile.tables import HarmonicLimits


class DcRipple(Requirement):
    """Double-frequency ripple of the DC voltage."""

    kinds = ("dc_ripple",)

    limit_percent: Positive = Field(description="amplitude, of the mean DC voltage")


class Harmonics(Requirement):
    """Harmonic currents in steady operation, in percent of the rated current (IEC 61000-4-7 subgroups)."""

    kinds = ("harmonics",)

    total_percent: Positive | None = Field(default=None, description="total rated-current distortion (TRD)")
    thd_percent: Positive | None = Field(default=None, description="total harmonic distortion, of the fundamental")
    orders: HarmonicLimits | None = None


class DcInjection(Requirement):
    """Direct current into the grid in steady operation."""

    kinds = ("dc_injection",)

    limit_percent: Positive = Field(description="of the rated current, rms")
