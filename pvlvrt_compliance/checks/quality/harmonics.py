"""The current is free of harmonics in steady operation."""

from collections.abc import Iterator
from typing import NamedTuple

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.quality.steady import SteadyWindow, steady_currents
from pvlvrt_compliance.data.marks import Marked, Number
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.extremes import largest
from pvlvrt_compliance.measure.groups import harmonic_subgroups, spectrum, thd, trd
from pvlvrt_compliance.profile.requirements import Harmonics
from pvlvrt_compliance.profile.tables import HarmonicLimits
from pvlvrt_compliance.results import Spectrum, SpectrumBar, Verdict
from pvlvrt_compliance.waveforms.container import Samples

KIND = "harmonics"


class HarmonicsCheck(Check):
    """Judges the currents of steady operation, before the disturbance and after it: each order, TRD and THD."""

    kind = KIND
    title = "Harmonic currents"
    requirement = Harmonics
    judges_up_to_trip = True

    def judge(self, requirement: Harmonics, evidence: Evidence) -> Verdict:
        """Judge harmonic subgroups by order, TRD and THD of each phase, before the disturbance and at the end.

        Over ten or twelve cycles each (IEC 61000-4-7); after a trip only those before. Orders and TRD are in percent of
        the rated current; TRD counts interharmonics too. THD is that of the subgroups, orders 2 to 40, in percent of
        the fundamental's. Reports the part with the least margin relative to its limit; a spectrum has no worst
        instant: the verdict points to where its window begins.

        Raises
        ------
        MeasurementError
            When the window before the disturbance is shorter than that, a current cannot be measured, or there is no
            fundamental.
        """
        parts = [
            _part(component, window)
            for window in steady_currents(evidence)
            for component in _components(requirement, evidence, window)
        ]
        return judged_by_parts(KIND, requirement, parts)

    def limits(self, requirement: Harmonics, evidence: Evidence) -> tuple[Spectrum, ...]:
        """All components of each window, in the phase with the most, with their limits."""
        return tuple(
            Spectrum(check=KIND, start_s=window.start_s, end_s=window.end_s, bars=tuple(map(_bar, found)))
            for window in steady_currents(evidence)
            if (found := list(_components(requirement, evidence, window)))
        )


class _Component(NamedTuple):
    """An order, or a total of several, in the phase that has the most of it."""

    order: int | None
    total: str  # of a total: its abbreviation
    what: str
    phase: str
    percent: float
    limit_percent: float
    rests_on: Marked


def _part(component: _Component, window: SteadyWindow) -> Part:
    what = f"{component.what}, over {window.start_s:.3f} s to {window.end_s:.3f} s"
    rests_on = (component.rests_on,)
    return Part(what, component.percent, component.limit_percent, "%", window.start_s, rests_on)


def _bar(of: _Component) -> SpectrumBar:
    return SpectrumBar(order=of.order, name=of.total, phase=of.phase, measured=of.percent, limit=of.limit_percent)


def _components(requirement: Harmonics, evidence: Evidence, window: SteadyWindow) -> Iterator[_Component]:
    subgroups = evidence.once((KIND, window.start_s), lambda: _subgroups(evidence, window))
    if requirement.orders is not None:
        yield from _orders(requirement.orders, subgroups)
    if requirement.total_percent is not None:
        total = trd(window.current, window.dt_s, window.frequency_hz, rated_rms=1.0)
        yield _total("TRD", "total rated-current distortion", total, requirement.total_percent)
    if requirement.thd_percent is not None:
        if subgroups[:, 1].min() < evidence.thresholds.least_fundamental_fraction.value:
            raise MeasurementError("there is no fundamental current to state a distortion of")
        yield _total("THD", "total harmonic distortion", thd(subgroups), requirement.thd_percent)


def _subgroups(evidence: Evidence, window: SteadyWindow) -> Samples:
    return harmonic_subgroups(spectrum(window.current, window.dt_s, window.frequency_hz, evidence.nominal.frequency_hz))


def _orders(limits: HarmonicLimits, subgroups: Samples) -> Iterator[_Component]:
    for order in range(2, subgroups.shape[-1]):
        row = limits.row_for(order)
        if row is not None:
            most, at = largest(subgroups[:, order], 1.0)
            phase, percent = "abc"[at], 100 * most
            what = f"harmonic {order} of the current in phase {phase}, of the rated current"
            yield _Component(order, "", what, phase, percent, row.limit_percent, limits.mark_of(row))


def _total(abbreviation: str, name: str, fractions: Samples, limit: Number) -> _Component:
    most, at = largest(fractions, 1.0)
    phase, percent = "abc"[at], 100 * most
    return _Component(None, abbreviation, f"{name} in phase {phase}", phase, percent, limit.value, limit)
