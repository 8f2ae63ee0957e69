"""From a record and what is known about its test to the evidence that checks see."""

from collections.abc import Callable

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import Disturbance, NormalVoltage
from pvlvrt_compliance.evidence.evidence import Evidence, floors_of
from pvlvrt_compliance.evidence.instruments import BY_DEFINITION, Instruments
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import STANDARD_RULES, WindowRules
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.thresholds import Thresholds
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms


def collect(
    profile: Profile,
    test: TestCase,
    waveforms: Waveforms,
    nominal: Nominal,
    available_power_w: float,
    disturbance: Disturbance | None = None,
    release: Callable[[Evidence], float | None] | None = None,
    instruments: Instruments = BY_DEFINITION,
) -> Evidence:
    """Measure a record and put it together with what is known about its test; parameters as `checks.evaluate`."""
    rules, disturbance = window_rules(profile), disturbance or disturbance_of(profile, test)
    return Evidence(
        waveforms=waveforms,
        nominal=nominal,
        disturbance=disturbance,
        available_power_w=available_power_w,
        measurements=measure(
            waveforms,
            nominal,
            disturbance.start_s,
            disturbance.clear_s,
            rules,
            floors_of(profile.thresholds),
            instruments.windows,
        ),
        rules=rules,
        cell_temperature_c=test.scenario.cell_temperature_c,
        blocked_below_pu=profile.conditions.blocked_below_pu.value,
        k_factor=test.k_factor,
        detection=profile.detection,
        requirements=profile.requirements,
        thresholds=profile.thresholds,
        expect=test.expect,
        by_s=test.by_s,
        row=test.demand,
        release=release,
        instruments=instruments,
    )


def collect_without_profile(
    waveforms: Waveforms,
    nominal: Nominal,
    disturbance: Disturbance,
    available_power_w: float,
    measurements: MeasuredWindows,
) -> Evidence:
    """What a record shows without the profile that it was judged by: every series to be looked at, for no verdict.

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    nominal : Nominal
        Base of the per-unit values.
    disturbance : Disturbance
        What the grid did.
    available_power_w : float
        What the PV array could give before the disturbance (W).
    measurements : MeasuredWindows
        What was measured in its windows.
    """
    return Evidence(
        waveforms=waveforms,
        nominal=nominal,
        disturbance=disturbance,
        available_power_w=available_power_w,
        measurements=measurements,
        rules=STANDARD_RULES,
        blocked_below_pu=0.0,
    )


def window_rules(profile: Profile) -> WindowRules:
    """The profile's measurement windows, or the standard ones."""
    if profile.windows is None:
        return STANDARD_RULES
    return WindowRules(**{name: number.value for name, number in profile.windows})


def disturbance_of(profile: Profile, test: TestCase) -> Disturbance:
    """What the scenario of a test asks of the grid."""
    return disturbance_asked(test.scenario, normal_voltage(profile.thresholds))


def normal_voltage(thresholds: Thresholds) -> NormalVoltage:
    """The voltages of normal operation as a disturbance goes by them."""
    return NormalVoltage(
        low_pu=thresholds.normal_low_pu.value,
        high_pu=thresholds.normal_high_pu.value,
        negative_pu=thresholds.normal_negative_pu.value,
    )
