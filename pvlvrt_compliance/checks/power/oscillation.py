"""Active and reactive power do not swing while the grid stands still."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.limits import about_the_line, of_each
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.data.marks import Number
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.measure.extremes import first_most
from pvlvrt_compliance.measure.swing import Swing, swing, tone
from pvlvrt_compliance.profile.requirements import Oscillation
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER, REACTIVE_POWER
from pvlvrt_compliance.waveforms.container import Samples

KIND = "oscillation"

_UNDAMPED = 0.01
"""Damping ratio below which words call it none: a swing then loses less than 6 % from peak to peak."""

_CYCLE_SLACK = 1e-3  # of a cycle: a frequency measured a hair off must not cost a stretch


class _Power(NamedTuple):
    """Half-cycle means of one power in a stretch."""

    name: str
    unit: str
    values: Samples
    swing: Swing


class OscillationCheck(StretchCheck):
    """Judges how far P and Q swing in each stretch in which the grid stands still, once it has settled."""

    kind = KIND
    title = "Oscillation of the power"
    requirement = Oscillation

    def stretches(self, requirement: Oscillation, evidence: Evidence) -> Sequence[Stretch]:  # noqa: ARG002
        """All that follow a step, the last one too: what swings after the disturbance swings for ever."""
        return evidence.stretches_until(self.until)

    def judge_stretch(self, requirement: Oscillation, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge the peak to peak of the half-cycle means of P and of Q, their straight lines taken away.

        Half a cycle leaves out what unbalance (2f) and harmonics (6f) swing by; what goes one way only, as a recovery
        does, does not count. Reports the power that swings further.

        Raises
        ------
        NotApplicable
            When something moves all along the stretch, or it is too short.
        MeasurementError
            When P or Q cannot be measured in it.
        """
        settled = _settled(requirement, evidence, stretch)
        t_s, step_s = evidence.t_s[settled], evidence.step_s[settled]
        limit = requirement.limit_fraction.value * evidence.nominal.apparent_power_kva
        worst = first_most(_powers(evidence, settled), lambda power: power.swing.peak_to_peak, limit)
        measured = worst.swing.peak_to_peak
        how = "" if measured <= limit else _in_words(t_s, worst.values, step_s)
        return judged_at_most(
            KIND,
            requirement,
            f"{worst.name} swings {measured:.1f} {worst.unit} peak to peak about {worst.swing.mean:.1f} {worst.unit}"
            f"{how} between {t_s[0]:.3f} s and {t_s[-1]:.3f} s; the limit is {limit:.1f} {worst.unit}",
            measured=measured,
            limit=limit,
            unit=worst.unit,
            at_s=t_s[worst.swing.at],
            rests_on=(
                requirement.limit_fraction,
                _settling(requirement, evidence, stretch),
                requirement.least_cycles,
            ),
            uncertainty=evidence.power_uncertainty_kva,
        )

    def limits(self, requirement: Oscillation, evidence: Evidence) -> tuple[Band, ...]:
        """The largest swing of P and of Q about their straight lines, in each stretch."""
        room = requirement.limit_fraction.value * evidence.nominal.apparent_power_kva

        def bands(stretch: Stretch) -> Iterator[Band]:
            settled = _settled(requirement, evidence, stretch)
            t_s = evidence.t_s[settled]
            span = (float(t_s[0]), float(t_s[-1]))
            for power, quantity in zip(_powers(evidence, settled), (ACTIVE_POWER, REACTIVE_POWER), strict=True):
                what = f"swing of {power.name}"
                yield about_the_line(KIND, quantity, what, span, power.swing.ends, room, half_cycle=True)

        return of_each(self.stretches(requirement, evidence), bands)


def _settled(requirement: Oscillation, evidence: Evidence, stretch: Stretch) -> slice:
    """The samples of a stretch that are looked at.

    Raises
    ------
    NotApplicable
        When something moves all along it, or it is too short.
    """
    if stretch.ramps:
        raise NotApplicable(f"the {' and the '.join(stretch.ramps)} moves from {stretch.begin_s:.3f} s on")
    begin_s, end_s = stretch.begin_s + _settling(requirement, evidence, stretch).value, stretch.end_s
    if (end_s - begin_s) * evidence.frequency_hz < requirement.least_cycles.value - _CYCLE_SLACK:
        raise NotApplicable(
            f"the stretch from {stretch.begin_s:.3f} s to {end_s:.3f} s leaves less than "
            f"{requirement.least_cycles.value:g} cycles once it is settled"
        )
    return evidence.samples_before(begin_s, end_s)


def _settling(requirement: Oscillation, evidence: Evidence, stretch: Stretch) -> Number:
    """What is left to the transient: the array's, which moves v_DC to another point, takes longer than the grid's."""
    # Once for all stretches, of which there may be thousands.
    of_array = evidence.once((KIND, "of the array"), lambda: frozenset(evidence.disturbance.steps_of("irradiance")))
    return requirement.array_settling_s if stretch.begin_s in of_array else requirement.settling_s


def _powers(evidence: Evidence, settled: slice) -> list[_Power]:
    return evidence.once((KIND, settled.start, settled.stop), lambda: _measured(evidence, settled))


def _measured(evidence: Evidence, settled: slice) -> list[_Power]:
    t_s, step_s = evidence.t_s[settled], evidence.step_s[settled]
    both = zip(("P", "Q"), ("kW", "kvar"), evidence.half_cycle_kva, strict=True)
    series = [(name, unit, require_finite(x[settled], name, t_s)) for name, unit, x in both]
    rated_kva = evidence.nominal.apparent_power_kva
    return [_Power(name, unit, x, swing(t_s, x, step_s, rated_kva)) for name, unit, x in series]


def _in_words(t_s: Samples, values: Samples, step_s: Samples) -> str:
    found = tone(t_s, values, step_s)
    if found is None:
        return ""
    undamped = found.damping_ratio < _UNDAMPED
    damping = "undamped" if undamped else f"with a damping ratio of {found.damping_ratio:.2f}"
    return f" at {found.frequency_hz:.0f} Hz, {damping},"
