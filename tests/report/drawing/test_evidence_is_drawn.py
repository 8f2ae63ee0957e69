"""What is drawn is the evidence that was judged: every series at every point."""

import dataclasses

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.voltages import voltage_quantity_pu
from pvlvrt_compliance.report.drawing.model import values
from pvlvrt_compliance.report.drawing.of_test import drawing
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from sampled import SAMPLE, sampled
from shown import curve

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.2)
SERIES = {
    **{f"u<sub>{name}</sub>": lambda e, k=k: e.voltage_pu[k] for k, name in enumerate("abc")},
    **{f"i<sub>{name}</sub>": lambda e, k=k: e.current_pu[k] for k, name in enumerate("abc")},
    "V<sup>+</sup>": lambda e: e.voltage_positive_pu,
    "V<sup>−</sup>": lambda e: e.voltage_negative_pu,
    "V<sup>+</sup> without the inverter's current": lambda e: e.sequence_pu("u0", 0),
    "lowest phase": lambda e: voltage_quantity_pu(e, "lowest_phase", "no_load"),
    "highest phase": lambda e: voltage_quantity_pu(e, "highest_phase", "no_load"),
    "lowest line to line": lambda e: voltage_quantity_pu(e, "lowest_line_to_line", "no_load"),
    "highest line to line": lambda e: voltage_quantity_pu(e, "highest_line_to_line", "no_load"),
    "mean phase": lambda e: voltage_quantity_pu(e, "mean_phase", "no_load"),
    "f": frequency_hz,
    "largest fundamental": lambda e: e.current_phase_pu.max(axis=0),
    "positive": lambda e: e.reactive_current_pu,
    "negative": lambda e: e.reactive_current_negative_pu,
    "share": lambda e: e.reactive_share,
    "p(t)": lambda e: e.instantaneous_kva.p,
    "q(t)": lambda e: e.instantaneous_kva.q,
    "P, half cycle": lambda e: e.half_cycle_kva.p,
    "Q, half cycle": lambda e: e.half_cycle_kva.q,
    "P": lambda e: e.active_power_kw,
    "Q": lambda e: e.reactive_power_kvar,
    "v<sub>DC</sub>": lambda e: e.dc_voltage_v,
}
"""What each curve is of, by its name in the legend."""

FINE = {
    **dict.fromkeys(("p(t)", "q(t)", "P", "Q", "P, half cycle", "Q, half cycle"), 0.1001),
    "v<sub>DC</sub>": 0.0501,
    "f": 5.001e-4,
    "share": 1.001e-3,
}
"""What a band may be off by, where it is not in pu: a fiftieth of what can be seen."""


def series_of(evidence, name):
    """The series that a name in a legend is of."""
    return SERIES[name](evidence)


def assert_is_drawn(evidence, drawn):
    """Points of curves are samples; bands hold all samples, but for what nobody sees."""
    names = set()
    for panel in (panel for panel in drawn.panels if panel.over == "time" and panel.key != "dc_ripple"):
        for line in (line for line in panel.lines if line.told):
            names.add(line.name)
            series = series_of(evidence, line.name)
            for run in line.runs:
                at = nearest(evidence, values(run.x))
                np.testing.assert_array_equal(run.y, series[at], err_msg=line.name)
        for area in (area for area in panel.areas if area.name in SERIES):
            names.add(area.name)
            series = series_of(evidence, area.name)
            for strip in area.strips:
                x = np.asarray(values(strip.x))
                inside = (evidence.t_s >= x[0]) & (evidence.t_s < x[-1])
                seen, t_s = series[inside], evidence.t_s[inside]
                seen, t_s = seen[np.isfinite(seen)], t_s[np.isfinite(seen)]
                fine = FINE.get(area.name, 2.001e-4)
                assert (np.interp(t_s, x, strip.lower) <= seen + fine).all(), area.name
                assert (np.interp(t_s, x, strip.upper) >= seen - fine).all(), area.name
    return names


def nearest(evidence, t_s):
    """Samples at some instants, each of which is one."""
    at = np.searchsorted(evidence.t_s, np.asarray(t_s) - 1e-9)
    np.testing.assert_allclose(evidence.t_s[at], t_s, rtol=0, atol=1e-9)
    return at


@pytest.mark.slow
@pytest.mark.parametrize("buckets", [1500, 300])
@pytest.mark.parametrize("name", SAMPLE)
def test_every_curve_is_the_evidence(name, buckets):
    """Frequency, trips, thin records, swells: what is drawn of a test is what its checks have seen, and all of it."""
    judged = sampled(name)
    names = assert_is_drawn(judged.evidence, drawing(judged.evidence, judged.result, buckets=buckets))
    moved = {what for step in judged.evidence.disturbance.steps for what in step.moved}
    assert "P" in names or not moved
    assert {"u<sub>a</sub>", "i<sub>c</sub>"} <= names or moved <= {"frequency"}


@pytest.mark.slow
@pytest.mark.parametrize("gone", ["i_", "u0_", "v_dc_v", "connected"])
def test_so_it_is_without_some_channels(gone):
    """What a recording does not hold is not drawn; the rest is as it was."""
    judged = sampled("es-nts-631-lt110kv:U75TPmax-1")
    segments = [
        Segment(s.t0_s, s.dt_s, {name: x for name, x in s.channels.items() if not name.startswith(gone)})
        for s in judged.evidence.waveforms
    ]
    evidence = dataclasses.replace(judged.evidence, waveforms=Waveforms(tuple(segments)))
    names = assert_is_drawn(evidence, drawing(evidence, judged.result))
    assert {"u<sub>a</sub>", "V<sup>+</sup>"} <= names
    assert ("P" in names) == (gone != "i_")
    assert ("v<sub>DC</sub>" in names) == (gone != "v_dc_v")


def test_a_step_of_the_frequency_does_not_disturb_what_is_drawn(make_test, make_evidence):
    """V- of 0.1 pu is drawn as 0.1 pu at 47 Hz as at 50 Hz, as it is judged, and not with what leaks of V+."""
    steps = [{"kind": "frequency_step", "t_s": 0.2, "to_hz": 47.0}]
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.4, events=steps)
    dt_s = 40.9568e-6
    t = dt_s * np.arange(round(scenario.end_s / dt_s))
    turn = 2 * np.pi * dt_s * np.cumsum(np.where(t < scenario.start_s + 0.2, 50.0, 47.0))
    shift = 2 * np.pi / 3 * np.arange(3)[:, np.newaxis]
    u = np.sqrt(2) * 230 * (np.cos(turn - shift) + 0.1 * np.cos(turn + shift))
    record = Waveforms((Segment(0.0, dt_s, dict(zip(("u_a_v", "u_b_v", "u_c_v"), u, strict=True))),))
    test = make_test(disturbance=disturbance_asked(scenario, NORMAL), bands=())
    t_s, negative = curve(drawing(make_evidence(record, test), test), "V<sup>−</sup>")
    settled = (t_s < scenario.start_s + 0.2) | (t_s > scenario.start_s + 0.4)
    assert negative[settled] == pytest.approx(0.1, abs=2e-3)
