"""All that a check of one's own is written with, here or in another package."""

from pvlvrt_compliance.checks.alone import judge_alone
from pvlvrt_compliance.checks.check import Check, RowCheck, StretchCheck
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.verdicts import judged, judged_at_most, pass_or_fail
from pvlvrt_compliance.data.marks import Choice, Flag, Fraction, NotNegative, Number, Numbers, Positive
from pvlvrt_compliance.disturbance.model import Disturbance, Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.profile.requirements import CustomRequirement, Requirement
from pvlvrt_compliance.results import Band, Characteristic, Drawn, Instant, Spectrum, SpectrumBar, Status, Verdict

__all__ = [
    "Band",
    "Characteristic",
    "Check",
    "Choice",
    "CustomRequirement",
    "Disturbance",
    "Drawn",
    "Evidence",
    "Flag",
    "Fraction",
    "Instant",
    "MeasurementError",
    "NotApplicable",
    "NotNegative",
    "Number",
    "Numbers",
    "Part",
    "Positive",
    "Requirement",
    "RowCheck",
    "Spectrum",
    "SpectrumBar",
    "Status",
    "Stretch",
    "StretchCheck",
    "Verdict",
    "judge_alone",
    "judged",
    "judged_at_most",
    "judged_by_parts",
    "pass_or_fail",
    "require_finite",
    "required",
]
