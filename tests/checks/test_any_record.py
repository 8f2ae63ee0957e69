"""Whatever a record is like, every built-in check gives a verdict that holds together."""

from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.disturbance.found import Thresholds, disturbance_found
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.collect import normal_voltage
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.profile.requirements import BUILT_IN, requirements_of
from pvlvrt_compliance.results import Status, Verdict
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

STEP_S = 8 * 40.9568e-6
CHANNELS = [f"{kind}_{p}_{'a' if kind == 'i' else 'v'}" for kind in ("u", "u0", "i") for p in "abc"]
CHANNELS += ["v_dc_v", "connected"]

sags = st.builds(
    lambda depth, phases, angle: Sag(depth=depth, phases=phases, angle_deg=angle),
    st.sampled_from([0.0, 0.1, 0.15, 0.5, 0.8, 0.95, 1.0]) | st.floats(0, 1),
    st.sampled_from(["abc", "a", "bc"]),
    st.just(0.0) | st.floats(-60, 60),
) | st.builds(lambda depth: Sag(depth=depth, phases="bc", two_phase=True), st.floats(0, 1))
instants = st.floats(0, 1.2)
events = st.lists(
    st.one_of(
        st.builds(lambda t, hz: {"kind": "frequency_step", "t_s": t, "to_hz": hz}, instants, st.floats(45, 64)),
        st.builds(
            lambda t, r, d: {"kind": "frequency_ramp", "t_s": t, "rate_hz_s": r, "duration_s": d},
            instants,
            st.floats(-10, 10),
            st.floats(0.02, 0.5),
        ),
        st.builds(lambda t, a: {"kind": "phase_jump", "t_s": t, "angle_deg": a}, instants, st.floats(-90, 90)),
        st.builds(
            lambda t, d, u: {"kind": "voltage_profile", "points": [(t, 1.0), (t, u), (t + d, u), (t + d, 1.0)]},
            instants,
            st.floats(0.01, 0.6),
            st.floats(0, 2),
        ),
        st.builds(
            lambda t, d, sag: {"kind": "sag", "t_s": t, "duration_s": d, "sag": sag},
            instants,
            st.floats(0.01, 0.6),
            sags,
        ),
    ),
    max_size=2,
)
levels_kw = st.sampled_from([0.0, 100.0, 500.0, -500.0, 5e4]) | st.floats(-600, 600)
benches = st.fixed_dictionaries(
    {},
    optional={
        "p_sag_kw": levels_kw,
        "q_sag_kvar": levels_kw,
        "p_after_kw": levels_kw,
        "q_after_kvar": levels_kw,
        "q_before_kvar": levels_kw,
        "recovers_after_s": st.floats(0, 2),
        "negative_reactive_pu": st.floats(-1, 1),
        "dc_ripple_percent": st.floats(0, 5),
        "healthy_pu": st.sampled_from([1.0, 1.0, 0.9, 1.1]),
        "disconnected_after_s": st.floats(-0.3, 2.0),
        "blocked_after_s": st.floats(-0.3, 2.0),
        "without": st.lists(st.sampled_from(CHANNELS), max_size=3, unique=True).map(tuple),
        "spoiled": st.dictionaries(st.sampled_from(CHANNELS), st.floats(0, 1.4), max_size=2),
    },
)
cuts = st.just(1.0) | st.floats(0.0, 1.0)
thinnings = st.none() | st.tuples(st.floats(0, 1), st.sampled_from([2, 3, 4]))


def all_kinds() -> list[Profile]:
    """Shipped profiles in which, together, every kind of requirement occurs; one has them all."""
    names = ["es-nts-631-lt110kv", "ieee1547-cat-ii", "ieee1547-cat-iii", "nerc-prc-029", "es-po-12.3", "dk-rfg"]
    profiles = [load_profile(name) for name in ("rey-boue-500kva", *names)]
    demands: dict[str, Any] = {}
    for profile in profiles:
        for kind, demand in profile.requirements.by_kind():
            demands.setdefault(kind, demand)
    everything = profiles[1].model_copy(update={"requirements": requirements_of(BUILT_IN)(**demands)})
    assert set(demands) == set(BUILT_IN)
    return [everything, *profiles]


PROFILES = all_kinds()


def shortened(waveforms: Waveforms, part: float, thinning: tuple[float, int] | None) -> Waveforms:
    """The first part of a record, thinned from some instant on."""
    segment = waveforms.segments[0]
    samples = max(int(part * len(segment)), 1)
    channels = {name: x[:samples] for name, x in segment.channels.items()}
    at = samples if thinning is None else max(int(thinning[0] * samples), 1)
    pieces = [Segment(0.0, segment.dt_s, {name: x[:at] for name, x in channels.items()})]
    if thinning is not None and at < samples:
        step = thinning[1]
        rest = {name: x[at::step] for name, x in channels.items()}
        pieces.append(Segment(at * segment.dt_s, step * segment.dt_s, rest))
    return Waveforms(tuple(pieces))


@draws(60, HealthCheck.function_scoped_fixture)
@given(
    profile=st.sampled_from(PROFILES),
    sag=sags,
    duration_s=st.sampled_from([0.02, 0.13, 0.3]) | st.floats(0.005, 0.7),
    happening=events,
    made=benches,
    part=cuts,
    thinning=thinnings,
)
def test_any_record(bench, profile, sag, duration_s, happening, made, part, thinning):
    """No record makes a built-in check raise or contradict itself."""
    profile = with_trust(profile)
    record = bench(asked=sag, duration_s=duration_s, profile=profile, scenario={"events": happening}, dt_s=STEP_S,
                   nominal=nominal_of(profile), **made)  # fmt: skip
    with np.errstate(all="ignore"):
        waveforms = shortened(record.waveforms(), part, thinning)
    result = evaluate(profile, record.test, waveforms, record.nominal, record.available_power_w)
    assert result.checks
    last_s = waveforms.end_s + 2 * waveforms.segments[-1].dt_s
    for check in result.checks:
        assert check.message
        assert check.status is not Status.ERROR, check.message
        numbers = (check.measured, check.limit, check.margin, check.at_s)
        if check.status in {Status.PASS, Status.FAIL} and not throughout(check):
            assert None not in numbers, check
            assert (check.margin >= 0) == (check.status is Status.PASS), check
            assert check.margin == pytest.approx(recomputed(check), rel=1e-6, abs=1e-5), check
        if check.at_s is not None:
            assert waveforms.t0_s <= check.at_s <= last_s, check


def throughout(check: Verdict) -> bool:
    """Whether a verdict is on a trip where connection is demanded for ever: without a time to hold it against."""
    return check.status is Status.FAIL and check.limit is None and check.margin is None and check.measured is not None


def recomputed(check: Verdict) -> float:
    """Margin by what the verdict says of its limit."""
    match check.bound:
        case "at_least":
            return check.measured - (check.limit - check.tolerance)
        case "at_most":
            return check.limit + check.tolerance - check.measured
        case "band":
            return check.limit + check.tolerance - abs(check.measured)
    raise AssertionError(f"{check.check} does not say what its limit is")


def with_trust(profile: Profile) -> Profile:
    """The profile without the conditions that would leave most of these records unjudged."""
    wide = profile.conditions.no_load_tolerance_pu.model_copy(update={"value": 10.0})
    share = profile.conditions.starting_power_fraction.model_copy(update={"value": 1.0})
    update = {"no_load_tolerance_pu": wide, "starting_power_fraction": share}
    return profile.model_copy(update={"conditions": profile.conditions.model_copy(update=update)})


def nominal_of(profile: Profile) -> Nominal:
    """Base of the per-unit values at the profile's frequency."""
    return Nominal(frequency_hz=profile.procedure.frequency_hz.value if profile.procedure.frequency_hz else 50.0)


@pytest.mark.parametrize("value", [1e306, -np.inf, np.nan])
@pytest.mark.parametrize("channel", ["u_b_v", "u0_b_v", "i_b_a", "v_dc_v"])
def test_numbers_that_overflow(bench, channel, value):
    """Whatever is computed with them, what is said is a verdict's reason, and no warning of one line of the source."""
    record = bench(asked=Sag(depth=0.5, phases="abc"), duration_s=0.3, profile=PROFILES[1])
    (segment,) = record.waveforms().segments
    spoiled = segment.channels[channel].copy()
    spoiled[len(spoiled) // 3 :: 7] = value
    waveforms = Waveforms((Segment(segment.t0_s, segment.dt_s, {**segment.channels, channel: spoiled}),))
    thresholds = Thresholds(normal_voltage(PROFILES[1].thresholds))
    with suppress(MeasurementError):  # it may show none
        disturbance_found(waveforms, record.nominal, thresholds)
    assert evaluate(PROFILES[1], record.test, waveforms, record.nominal, record.available_power_w).checks
