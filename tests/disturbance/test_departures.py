"""When a step was: to the sample, whatever the point on wave, and as it was seen where nothing tells it better."""

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.departures import departure_s
from pvlvrt_compliance.waveforms import Segment, Waveforms

CYCLE_S, PEAK_V, DT_S, STEP_S = 0.02, 325.0, 4e-5, 0.3


def voltages(dt_s=DT_S, *, left=0.5, phases="abc", turned=0.0, frequency_hz=50.0, noise=0.0, begin_s=0.0):
    """Phases of which some lose a part at `STEP_S`."""
    t = begin_s + dt_s * np.arange(round((0.5 - begin_s) / dt_s))
    draw = np.random.default_rng(3)
    return Segment(
        begin_s,
        dt_s,
        {
            f"u_{name}_v": PEAK_V
            * (1 - (1 - left) * (name in phases) * (t >= STEP_S - 1e-9))
            * np.cos(2 * np.pi * (frequency_hz * t - k / 3) + turned)
            + noise * PEAK_V * draw.standard_normal(len(t))
            for k, name in enumerate("abc")
        },
    )


def departed_s(segment, seen_s=STEP_S + 0.7 * CYCLE_S):
    """When a step left the voltages that a one-cycle voltage shows later."""
    return departure_s(Waveforms((segment,)), "u", seen_s, CYCLE_S, PEAK_V)


@pytest.mark.parametrize("turned_deg", range(0, 360, 30))
@pytest.mark.parametrize(("left", "phases"), [(0.5, "abc"), (0.0, "abc"), (0.3, "c"), (1.2, "abc"), (0.9, "b")])
def test_a_step_is_told_to_the_sample(left, phases, turned_deg):
    """A phase that is at zero when it steps takes as long as it needs to differ by a hundredth."""
    found = departed_s(voltages(left=left, phases=phases, turned=np.radians(turned_deg)))
    latest_s = np.arcsin(min(0.0101 / abs(1 - left), 1.0)) / (2 * np.pi * 50) + DT_S
    assert STEP_S - 1e-9 <= found <= STEP_S + (DT_S / 2 if phases == "abc" else latest_s)


@pytest.mark.parametrize(("noise", "frequency_hz"), [(0.005, 50.0), (0.0, 50.4), (0.0, 49.6), (0.003, 50.2)])
def test_what_differs_anyway_is_no_step(noise, frequency_hz):
    """Noise, and a cycle that is another than the nominal one."""
    found = departed_s(voltages(left=0.5, noise=noise, frequency_hz=frequency_hz))
    assert found == pytest.approx(STEP_S, abs=2e-3)


@pytest.mark.parametrize("dt_s", [1e-4, 4.09568e-5, 1e-3])
def test_steps_of_any_length(dt_s):
    """Where a cycle is no whole number of samples, too."""
    assert departed_s(voltages(dt_s)) == pytest.approx(STEP_S, abs=dt_s)


def test_what_cannot_be_told_is_as_it_was_seen():
    """Without a step, and without three cycles before it at one step of the samples."""
    assert departed_s(voltages(left=1.0)) == STEP_S + 0.7 * CYCLE_S
    assert departed_s(voltages(begin_s=0.28)) == STEP_S + 0.7 * CYCLE_S
    fine, coarse = voltages(begin_s=0.28), voltages(4 * DT_S)
    coarse = Segment(0.0, 4 * DT_S, {name: x[: round(0.28 / (4 * DT_S))] for name, x in coarse.channels.items()})
    seen_s = STEP_S + 0.7 * CYCLE_S
    assert departure_s(Waveforms((coarse, fine)), "u", seen_s, CYCLE_S, PEAK_V) == seen_s


@pytest.mark.parametrize("turned_deg", [0, 40, 90])
@pytest.mark.parametrize("lasts_s", [0.03, 0.04, 0.05, 0.06, 0.1])
def test_a_short_sag_ends_when_it_does(lasts_s, turned_deg):
    """Its own beginning, which a one-cycle voltage shows until 20 ms later, makes its end no harder to tell."""
    segment = voltages(turned=np.radians(turned_deg))
    back = segment.index_at(STEP_S + lasts_s)
    channels = {name: np.concatenate([x[:back], 2 * x[back:]]) for name, x in segment.channels.items()}
    found = departed_s(Segment(0.0, DT_S, channels), STEP_S + lasts_s + 0.7 * CYCLE_S)
    assert found == pytest.approx(STEP_S + lasts_s, abs=2 * DT_S)


def test_a_step_that_is_still_seen_is_not_taken_for_the_next():
    """Where the search would begin within a cycle of it, the next is as it was seen."""
    segment = voltages()
    seen_s = STEP_S + 1.5 * CYCLE_S
    assert departed_s(segment, seen_s) == seen_s
