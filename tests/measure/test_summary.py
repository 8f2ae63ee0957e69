import math

import numpy as np
import pytest

from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Segment, Waveforms

START_S, CLEAR_S, END_S = 0.3, 0.8, 1.95
NOMINAL = Nominal()
U, I = NOMINAL.phase_voltage_peak_v, NOMINAL.phase_current_peak_a  # noqa: E741


@pytest.fixture(scope="module")
def sag_record(three_phase, dt_s):
    """A record whose voltages and currents switch between two steady states at the start and the clearing."""

    def make(frequency_hz=50.0, u_sag=(0.7, 0.3, 0.3), i_sag=(0.8, 0.2, 0), harmonics=None, spike_s=None):
        n = int(END_S / dt_s)
        t = dt_s * np.arange(n)
        sagging = (t >= START_S) & (t < CLEAR_S)
        channels = {}
        states = {"u": ((1, 0, 0), u_sag), "i": ((0.9, 0, 0), i_sag)}
        for kind, (healthy, low) in states.items():
            base = U if kind == "u" else I
            added = {h: tuple(base * x for x in s) for h, s in (harmonics or {}).items()} if kind == "i" else None
            whole = three_phase(kind, tuple(base * x for x in healthy), frequency_hz, n, added)
            lowered = three_phase(kind, tuple(base * x for x in low), frequency_hz, n, added)
            channels |= {name: np.where(sagging, lowered[name], whole[name]) for name in whole}
        if spike_s is not None:
            channels["i_b_a"][int(spike_s / dt_s)] = -1.7 * I
        channels["v_dc_v"] = 850 + 20 * t + 0.85 * np.cos(4 * np.pi * frequency_hz * t)
        channels["v_fault_pu"] = np.where(sagging, 0.7, 1.0)
        channels["q_ref_var"] = np.where(sagging, 160e3, 0.0)
        channels["p_ref_w"] = np.where(sagging, 119e3, 450e3)
        channels["connected"] = np.ones(n)
        return channels

    return make


def record(channels, dt_s=40.9568e-6):
    """Waveforms of one segment."""
    return Waveforms((Segment(0.0, dt_s, channels),))


@pytest.mark.parametrize("frequency_hz", [47.6, 50.0, 60.0, 62.1])
def test_a_sag_is_measured_in_all_windows(sag_record, frequency_hz):
    """Voltages, currents and powers of both steady states are found, at any frequency, whatever the setting says."""
    found = measure(record(sag_record(frequency_hz)), NOMINAL, START_S, CLEAR_S)
    for healthy in (found.before, found.after):
        assert healthy.voltage_positive_pu == pytest.approx(1, abs=1e-5)
        assert healthy.voltage_negative_pu == pytest.approx(0, abs=1e-5)
        assert healthy.active_power_kw == pytest.approx(450, abs=0.01)
        assert healthy.active_power_2f_kw == pytest.approx(0, abs=0.01)
    during = found.during
    assert during.voltage_positive_pu == pytest.approx(0.7, abs=1e-5)
    assert during.voltage_negative_pu == pytest.approx(0.3, abs=1e-5)
    assert during.active_power_kw == pytest.approx(500 * (0.7 * 0.8 + 0.3 * 0.2), abs=0.01)
    assert during.reactive_power_kvar == pytest.approx(0, abs=0.01)
    assert during.active_power_2f_kw == pytest.approx(500 * (0.7 * 0.2 + 0.3 * 0.8), abs=0.01)
    # Phase a has both sequences in phase; b and c have them 120 degrees apart.
    assert during.current_phase_pu == pytest.approx((1.0, math.sqrt(0.52), math.sqrt(0.52)), abs=1e-5)
    assert during.current_thd_percent == pytest.approx(0, abs=1e-6)
    measured_hz = [w.frequency_hz for w in (found.before, during, found.after)]
    assert measured_hz == pytest.approx([frequency_hz] * 3, abs=1e-3)


@pytest.mark.parametrize("later_hz", [50.7, 49.0])
def test_a_frequency_that_is_another_one_in_the_window(three_phase, dt_s, later_hz):
    """Where the frequency steps as the test begins, what follows is measured at the new one."""
    n = int(END_S / dt_s)
    before = dt_s * np.arange(n) < START_S
    channels = {}
    for kind, base in (("u", U), ("i", I)):
        first, then = (three_phase(kind, (base, 0.1 * base, 0), f, n) for f in (50.0, later_hz))
        channels |= {name: np.where(before, first[name], then[name]) for name in first}
    found = measure(record(channels), NOMINAL, START_S, 1.1)
    for window in (found.before, found.during):
        assert window.voltage_positive_pu == pytest.approx(1, abs=1e-4)
        assert window.voltage_negative_pu == pytest.approx(0.1, abs=1e-4)
        assert window.active_power_kw == pytest.approx(505, abs=0.1)


def test_reactive_power_is_positive_when_the_current_lags(sag_record):
    """Q = 3/2 |U+| |I+| for a current 90 degrees behind."""
    found = measure(record(sag_record(u_sag=(0.4, 0, 0), i_sag=(-1j, 0, 0))), NOMINAL, START_S, CLEAR_S)
    assert found.during.reactive_power_kvar == pytest.approx(200, abs=0.01)
    assert found.during.active_power_kw == pytest.approx(0, abs=0.01)


@pytest.mark.parametrize("frequency_hz", [50.0, 60.0])
def test_dc_ripple_on_a_ramp(sag_record, frequency_hz):
    """0.85 V at twice the frequency on a ramp around 850 V and more is 0.1 %, in percent of the window's mean."""
    during = measure(record(sag_record(frequency_hz)), NOMINAL, START_S, CLEAR_S).during
    middle = 850 + 20 * (during.start_s + during.end_s) / 2
    assert during.dc_voltage_mean_v == pytest.approx(middle, abs=0.01)
    assert during.dc_voltage_2f_percent == pytest.approx(100 * 0.85 / middle, rel=2e-3)


def test_distortion_is_that_of_the_worst_phase(sag_record):
    """A 5th harmonic of 3 % of nominal in every phase weighs most in the phase with the least fundamental."""
    found = measure(record(sag_record(harmonics={5: (0, 0.03, 0)})), NOMINAL, START_S, CLEAR_S)
    assert found.before.current_thd_percent == pytest.approx(100 * 0.03 / 0.9, abs=1e-3)
    assert found.during.current_thd_percent == pytest.approx(100 * 0.03 / math.sqrt(0.52), abs=1e-3)


@pytest.mark.parametrize(
    ("spike_s", "where"), [(0.301, "during"), (0.799, "during"), (0.801, "after"), (1.2, "after"), (0.1, "before")]
)
def test_the_largest_current_covers_the_sag_and_all_that_follows(sag_record, spike_s, where):
    """One sample of 1.7 pu is found in `during` from start to clearing, in `after` from there on, nowhere else."""
    found = measure(record(sag_record(spike_s=spike_s)), NOMINAL, START_S, CLEAR_S)
    peaks = {name: getattr(found, name).current_peak_pu for name in ("before", "during", "after")}
    assert peaks.pop(where) == pytest.approx(1.7)
    assert max(peaks.values()) <= 1.0 + 1e-9


def test_after_a_trip(sag_record, dt_s):
    """Currents that stay zero are measured as zero; distortion and ripple of what is not there are left open."""
    channels = sag_record()
    tripped = dt_s * np.arange(len(channels["i_a_a"])) > 0.31
    for phase in "abc":
        channels[f"i_{phase}_a"][tripped] = 0.0
    found = measure(record(channels), NOMINAL, START_S, CLEAR_S)
    assert found.during.current_phase_pu == pytest.approx((0, 0, 0), abs=1e-12)
    assert found.during.current_thd_percent is None
    assert found.during.current_peak_pu == pytest.approx(1, abs=0.01)
    assert found.after.current_peak_pu == 0
    assert found.after.active_power_kw == pytest.approx(0, abs=1e-9)


def test_a_dead_short(sag_record):
    """At residual voltage zero everything is measured but the frequency."""
    during = measure(record(sag_record(u_sag=(0, 0, 0), i_sag=(0, 0, 0))), NOMINAL, START_S, CLEAR_S).during
    assert during.voltage_positive_pu == pytest.approx(0, abs=1e-9)
    assert during.frequency_hz is None


def test_what_the_controller_believed(sag_record):
    """The controller's channels are averaged over the window during the sag, with powers in kilo."""
    channels = sag_record()
    believed = measure(record(channels), NOMINAL, START_S, CLEAR_S).controller
    assert (believed.v_fault_pu, believed.q_ref_kvar, believed.p_ref_kw) == pytest.approx((0.7, 160, 119))
    del channels["q_ref_var"]
    assert measure(record(channels), NOMINAL, START_S, CLEAR_S).controller.q_ref_kvar is None


def test_a_recording_without_the_inside_of_the_inverter(sag_record):
    """A laboratory's record has voltages and currents only: what needs more is None, the rest is measured."""
    channels = {name: x for name, x in sag_record().items() if name[:2] in {"u_", "i_"}}
    found = measure(record(channels), NOMINAL, START_S, CLEAR_S)
    assert (found.during.dc_voltage_mean_v, found.during.dc_voltage_2f_percent, found.controller) == (None, None, None)
    assert found.during.active_power_kw == pytest.approx(310, abs=0.01)


def test_voltages_alone(sag_record):
    """Without currents there are voltages and no powers."""
    channels = {name: x for name, x in sag_record().items() if name.startswith("u_")}
    during = measure(record(channels), NOMINAL, START_S, CLEAR_S).during
    assert (during.active_power_kw, during.current_phase_pu, during.current_peak_pu) == (None, None, None)
    assert during.voltage_positive_pu == pytest.approx(0.7, abs=1e-5)


def test_a_gap_in_a_channel_is_left_open(sag_record, dt_s):
    """A sample that is not a number leaves open what rests on it, and nothing else."""
    channels = sag_record()
    channels["v_dc_v"][int(0.6 / dt_s)] = np.nan
    channels["i_c_a"][int(0.6 / dt_s)] = np.nan
    found = measure(record(channels), NOMINAL, START_S, CLEAR_S)
    open_quantities = {name for name, value in found.during.model_dump().items() if value is None}
    assert open_quantities == {
        "active_power_kw",
        "reactive_power_kvar",
        "active_power_2f_kw",
        "current_phase_pu",
        "current_peak_pu",
        "current_thd_percent",
        "dc_voltage_mean_v",
        "dc_voltage_2f_percent",
    }
    assert None not in found.before.model_dump().values()


def test_a_short_record_leaves_windows_out(sag_record, dt_s):
    """A record that ends soon after clearing has no window after, and a short sag none during."""
    channels = {name: x[: int(1.0 / dt_s)] for name, x in sag_record().items()}
    assert measure(record(channels), NOMINAL, START_S, CLEAR_S).after is None
    found = measure(record(channels), NOMINAL, START_S, START_S + 0.1)
    assert (found.during, found.controller) == (None, None)


@pytest.mark.parametrize(("offset", "measured"), [(0.0, True), (0.3, False)])
def test_a_change_of_step_inside_a_window(sag_record, dt_s, offset, measured):
    """A window that crosses a change of step is measured where the grids fit, else left out; peaks look across it."""
    channels = sag_record(spike_s=0.35)
    cut = int(0.65 / dt_s)
    fine = Segment(0.0, dt_s, {name: x[:cut] for name, x in channels.items()})
    coarse = Segment((cut + offset) * dt_s, 2 * dt_s, {name: x[cut::2] for name, x in channels.items()})
    found = measure(Waveforms((fine, coarse)), NOMINAL, START_S, CLEAR_S)
    assert (found.during is not None) is measured
    if measured:
        whole = measure(Waveforms((Segment(0.0, dt_s, channels),)), NOMINAL, START_S, CLEAR_S).during
        for (name, x), (_, y) in zip(found.during, whole, strict=True):
            assert x == pytest.approx(y, rel=1e-5, abs=1e-5), name
    assert found.before.active_power_kw == pytest.approx(450, abs=0.01)
    assert found.after.active_power_kw == pytest.approx(450, abs=0.01)
    # Cut at the same place, but for a sag that was cleared before: the window lies in the fine part again.
    assert measure(Waveforms((fine, coarse)), NOMINAL, START_S, 0.62).during.current_peak_pu == pytest.approx(1.7)


def test_a_long_window(three_phase, dt_s):
    """Means and fundamentals over the whole of a long window; distortion and frequency at its end."""
    n = int(8.0 / dt_s)
    early = np.arange(n) < n // 2
    channels = three_phase("u", (U, 0, 0), 50.0, n)
    clean = three_phase("i", (0.5 * I, 0, 0), 50.0, n)
    distorted = three_phase("i", (0.5 * I, 0, 0), 50.0, n, {5: (0, 0.05 * I, 0)})
    channels |= {name: np.where(early, clean[name], distorted[name]) for name in clean}
    channels["v_dc_v"] = np.where(early, 800.0, 900.0)
    during = measure(Waveforms((Segment(0.0, dt_s, channels),)), NOMINAL, 0.3, 6.8).during
    assert (during.start_s, during.end_s) == (pytest.approx(0.4), pytest.approx(6.78))
    assert during.active_power_kw == pytest.approx(250, abs=0.01)
    assert during.current_phase_pu == pytest.approx((0.5,) * 3, abs=1e-6)
    assert during.current_thd_percent == pytest.approx(10, abs=1e-4)
    assert during.dc_voltage_mean_v == pytest.approx((800 * 3.6 + 900 * 2.78) / 6.38, abs=0.01)
    assert during.frequency_hz == pytest.approx(50, abs=1e-6)


def test_no_voltage_before_the_sag(sag_record):
    """Where there is no voltage to measure the frequency on, the nominal one serves."""
    channels = sag_record()
    for phase in "abc":
        channels[f"u_{phase}_v"][:] = 0.0
    found = measure(record(channels), NOMINAL, START_S, CLEAR_S)
    assert found.before.frequency_hz is None
    assert found.before.current_phase_pu == pytest.approx((0.9, 0.9, 0.9))
