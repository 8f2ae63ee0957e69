"""The current is free of harmonics in steady operation."""

from collections.abc import Iterator

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.quality.steady import SteadyWindow, steady_currents
from pvlvrt_compliance.data.marks import Marked, Number
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.groups import harmonic_subgroups, spectrum, thd, trd
from pvlvrt_compliance.profile.requirements import Harmonics
from pvlvrt_compliance.profile.tables import HarmonicLimits
from pvlvrt_compliance.results import Verdict
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
        return judged_by_parts(
            KIND,
            requirement,
            [part for window in steady_currents(evidence) for part in _parts(requirement, evidence, window)],
        )


def _parts(requirement: Harmonics, evidence: Evidence, window: SteadyWindow) -> Iterator[Part]:
    found = spectrum(window.current, window.dt_s, window.frequency_hz, evidence.nominal.frequency_hz)
    subgroups = harmonic_subgroups(found)
    if requirement.orders is not None:
        yield from _orders(requirement.orders, subgroups, window)
    if requirement.total_percent is not None:
        total = trd(window.current, window.dt_s, window.frequency_hz, rated_rms=1.0)
        yield _worst_phase("total rated-current distortion", total, requirement.total_percent, window)
    if requirement.thd_percent is not None:
        if subgroups[:, 1].min() < evidence.thresholds.least_fundamental_fraction.value:
            raise MeasurementError("there is no fundamental current to state a distortion of")
        yield _worst_phase("total harmonic distortion", thd(subgroups), requirement.thd_percent, window)


def _orders(limits: HarmonicLimits, subgroups: Samples, window: SteadyWindow) -> Iterator[Part]:
    for order in range(2, subgroups.shape[-1]):
        row = limits.row_for(order)
        if row is not None:
            phase = int(subgroups[:, order].argmax())
            what = f"harmonic {order} of the current in phase {'abc'[phase]}, of the rated current"
            yield _part(what, subgroups[phase, order], row.limit_percent, window, limits.mark_of(row))


def _worst_phase(name: str, fractions: Samples, limit: Number, window: SteadyWindow) -> Part:
    phase = int(np.argmax(fractions))
    return _part(f"{name} in phase {'abc'[phase]}", fractions[phase], limit.value, window, limit)


def _part(what: str, fraction: float, limit_percent: float, window: SteadyWindow, rests_on: Marked) -> Part:
    when = f"over {window.start_s:.3f} s to {window.end_s:.3f} s"
    return Part(f"{what}, {when}", 100 * float(fraction), limit_percent, "%", window.start_s, (rests_on,))
