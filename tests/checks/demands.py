"""Requirements that several files of tests judge by, in such numbers as codes have."""

from typing import Any

from pvlvrt_compliance.results import TestResult, Verdict

CONTROL_STEP_S = 40.9568e-6
"""For records whose edges lie a tenth of a millisecond apart; others are sampled four times less often."""

MARK = {"confidence": "chosen", "source": "the test"}

K_FACTOR: dict[str, Any] = {
    "k": 2.0,
    "dead_band_pu": 0.1,
    "dead_band_mode": "none",
    "reference": "prefault",
    "tolerance_plus_pu": 0.2,
    "tolerance_minus_pu": 0.1,
    "limit_pu": 1.0,
    "blocking_allowed_below_pu": 0.2,
}
"""Additional reactive current, of either sequence."""

DYNAMICS = {
    "activation_pu": 0.05,
    "activation_s": 0.02,
    "response_fraction": 0.9,
    "response_s": 0.05,
    "settling_s": 0.06,
    "band_plus": 0.2,
    "band_minus": 0.1,
    "least_change_pu": 0.05,
}
"""How fast it comes."""

DYNAMICS_OF_LARGE_STEPS = DYNAMICS | {"least_change_pu": 0.1}

RATIO = {
    "curve": MARK | {"points": [[0, 0.9], [0.5, 0.9], [0.85, 0]]},
    "within_s": 0.15,
    "tolerance": 0.01,
    "least_current_pu": 0.05,
}
"""Its share in the current."""

DETECTION = {"enter_below_pu": 0.85, "leave_above_pu": 0.85}


def checks_of(result: TestResult) -> dict[str, Verdict]:
    """Verdicts by kind."""
    return {check.check: check for check in result.checks}
