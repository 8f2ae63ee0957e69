"""During a sag the current is reactive in the share that the voltage asks for."""

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.profile.requirements import ReactiveRatio
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.waveforms.container import Samples

KIND = "reactive_ratio"


class ReactiveRatioCheck(Check):
    """Judges the share of reactive current in the positive-sequence current during the sag, at each instant."""

    kind = KIND
    title = "Share of the reactive current"
    requirement = ReactiveRatio

    def judge(self, requirement: ReactiveRatio, evidence: Evidence) -> Verdict:
        """Judge I_reactive / I_total of the positive sequence's fundamental at every instant; reports the worst.

        I_total is the whole positive-sequence current, so that the share is the sine of its angle behind V+: the share
        does not depend on how an inverter shares its current between phases. Reactive current that lowers V+ has a
        negative share. Counts from ``within_s`` after the start to clearing, at the V+ of the same cycle, and only
        while that is a voltage event by the profile's thresholds: without one nothing is demanded, and nothing
        forbidden.

        Raises
        ------
        NotApplicable
            When the sag is shorter than that, is no event, or the current or the voltage is too small to have a share.
        MeasurementError
            When V+ or the current cannot be measured.
        """
        t_s, v_positive, share = _shares(requirement, evidence)
        demanded = requirement.curve.share_at(v_positive)
        worst = int((share - demanded).argmin())
        limit = float(demanded[worst]) - requirement.tolerance.value
        margin = float(share[worst]) - limit
        return judged(
            KIND,
            requirement,
            pass_or_fail(margin >= 0),
            f"smallest share of the reactive current against the demand is {share[worst]:.3f}, at {t_s[worst]:.3f} s; "
            f"{demanded[worst]:.3f} is demanded at V+ = {v_positive[worst]:.3f} pu, with a tolerance of "
            f"{requirement.tolerance.value:g}",
            measured=share[worst],
            limit=limit,
            margin=margin,
            unit="",
            at_s=t_s[worst],
            rests_on=(requirement.curve, requirement.within_s, requirement.tolerance),
        )


def _shares(requirement: ReactiveRatio, evidence: Evidence) -> tuple[Samples, Samples, Samples]:
    """Instants (s), V+ (pu) and shares where there is one."""
    grid = evidence.disturbance
    inside = evidence.between(grid.start_s + requirement.within_s.value, grid.clear_s)
    t_s = evidence.t_s[inside]
    if not len(t_s):
        raise NotApplicable(
            f"the sag of {grid.duration_s:.3f} s is cleared before the {requirement.within_s.value:g} s from which "
            "the share is demanded"
        )
    v_positive = require_finite(evidence.voltage_positive_pu[inside], "V+", t_s)
    demanded = evidence.is_event(v_positive)
    if not demanded.any():
        raise NotApplicable("V+ does not pass the threshold of detection: no share is demanded")
    require_finite(evidence.current_phase_pu[:, inside], "the current", t_s)
    active, reactive = (part[inside] for part in evidence.current_positive_pu)
    total = np.hypot(active, reactive)
    flowing = demanded & (
        total >= requirement.least_current_pu.value
    )  # false where there is no voltage: not a number there
    if not flowing.any():
        raise NotApplicable(
            f"the positive-sequence current stays below {requirement.least_current_pu.value:g} pu, or there is no "
            "voltage to tell reactive current by"
        )
    return t_s[flowing], v_positive[flowing], reactive[flowing] / total[flowing]
