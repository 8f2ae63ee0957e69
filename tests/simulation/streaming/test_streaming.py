"""Compiled series are the ones that `measure` defines, whatever the record is like."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.instruments import BY_DEFINITION
from pvlvrt_compliance.evidence.series import Series
from pvlvrt_compliance.measure.power import sequence_current
from pvlvrt_compliance.measure.sequences import phase_amplitudes
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.translate import nominal_of
from pvlvrt_compliance.study.instruments import compiled_instruments
from pvlvrt_compliance.waveforms import Segment

COMPILED = compiled_instruments()
NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
STEPS_S = (40.9568e-6, 163.8272e-6, 327.6544e-6, 1.9e-3)
CHANNELS = ("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a")


@st.composite
def segments(draw):
    """A record: sequences, harmonics and noise, a phase jump, a time without voltage, a sample that is no number."""
    noise = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    dt_s, n = draw(st.sampled_from(STEPS_S)), draw(st.integers(1, 3000))
    angle = 2 * np.pi * dt_s * np.cumsum(draw(moving(n)))
    angle[draw(st.integers(0, n - 1)) :] += draw(st.floats(-3, 3))
    channels = {}
    for k, name in enumerate(CHANNELS):
        shift = k % 3 * 2 * np.pi / 3
        wave = 300 * np.cos(angle - shift) + draw(st.sampled_from([0.0, 60.0])) * np.cos(angle + shift)
        channels[name] = wave + draw(st.sampled_from([0.0, 5.0])) * noise.normal(size=n) + 9 * np.cos(5 * angle + k)
    begin = draw(st.integers(0, n))
    faint = draw(st.sampled_from([1.0, 0.0, 1e-3]))
    for name in CHANNELS[:3]:
        channels[name][begin : begin + draw(st.sampled_from([0, n // 3, n]))] *= faint
    if (bad := draw(st.sampled_from([None, None, np.nan, np.inf, -np.inf]))) is not None:
        channels[draw(st.sampled_from(CHANNELS))][draw(st.integers(0, n - 1))] = bad
    return Segment(draw(st.sampled_from([0.0, 7.3])), dt_s, channels)


def moving(n):
    """Frequency at each sample (Hz): steady, at nominal or beside it, a ramp, or a sway."""
    k = np.arange(n) / n
    return st.sampled_from(
        [np.full(n, 50.0), np.full(n, 49.97), 50 + 1.5 * k, 49 + 2 * np.sin(9 * k), np.where(k < 0.5, 50.0, 51.0)]
    )


def same(found, expected, scale):
    """Values to 1e-9 of a scale where the definition has any, and none where it has none."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    known = np.isfinite(expected)
    assert np.array_equal(np.isfinite(found), known)
    assert np.abs(found[known] - expected[known]).max(initial=0) <= 1e-9 * scale


@given(segments(), st.data())
@draws(80)
def test_series_are_those_of_the_definition(segment, data):
    """Sequences and powers at a steady frequency and at one that moves, and the frequency itself."""
    window_hz = data.draw(st.one_of(st.floats(47, 63), moving(len(segment))))
    floor = data.draw(st.sampled_from([1.0, 30.0, 290.0]))
    for measured, scale in (
        (lambda by: by.sequence_phasors(segment, "u", window_hz), 300),
        (lambda by: by.sequence_phasors(segment, "i", window_hz), 300),
        (lambda by: by.mean_powers(segment, window_hz), 3e5),
        (lambda by: by.tracked_frequency(segment, 50.0, "u", floor), 50),
    ):
        with np.errstate(invalid="ignore"):  # of what is infinite
            expected = measured(BY_DEFINITION)
        same(measured(COMPILED), expected, scale)


@given(segments(), st.data())
@draws(80)
def test_amplitudes_and_currents_are_those_of_the_definition(segment, data):
    """Of sequences and phases by any base, and a current along its voltage: none where that is below the floor."""
    window_hz = data.draw(st.one_of(st.floats(47, 63), moving(len(segment))))
    base, floor = data.draw(st.sampled_from([1.0, 326.6, 1e-3])), data.draw(st.sampled_from([1.0, 30.0, 290.0]))
    with np.errstate(invalid="ignore"):
        u, i = (BY_DEFINITION.sequence_phasors(segment, kind, window_hz) for kind in "ui")
        same(COMPILED.sequence_amplitudes(segment, "u", window_hz, base), np.abs(u[:2]) / base, 300 / base)
        expected = phase_amplitudes(segment, "i", window_hz) / base
        same(COMPILED.phase_amplitudes(segment, "i", window_hz, base), expected, 300 / base)
        for index in (0, 1):
            if np.abs(np.abs(u[index]) - floor).min() > 1e-6 * floor:  # which side of it is nothing but rounding
                expected = np.stack(sequence_current(u[index], i[index], floor)) / base
                # The angle of a faint voltage has the rounding of the strong one that it is found beside.
                scale = 300 * max(1.0, 300 / floor) / base
                same(COMPILED.sequence_current(segment, index, window_hz, floor, base), expected, scale)


@pytest.mark.parametrize("by", [BY_DEFINITION, COMPILED], ids=["numpy", "compiled"])
def test_a_record_of_known_sequences_and_powers(by):
    """Amplitude, angle, P, Q and frequency of sinusoids made in extended precision, from the first cycle to the last.

    At each sample to what the cubic leaves between samples; on the mean, where that cancels, to rounding.
    """
    hz, n, third = 50.37, 60_000, 2 * np.arccos(np.longdouble(-1)) / 3
    angle = 3 * third * np.longdouble(hz) * np.longdouble(STEPS_S[0]) * np.arange(n)
    channels = {}
    for k, name in enumerate(CHANNELS):
        size, lag = (325, 0) if name.startswith("u") else (1000, np.longdouble(0.4))
        channels[name] = (size * np.cos(angle - k % 3 * third - lag)).astype(np.float64)
    segment = Segment(0.0, STEPS_S[0], channels)
    apparent = 1.5 * 325 * 1000
    positive, (p, q) = by.sequence_phasors(segment, "u", hz)[0], by.mean_powers(segment, hz)
    for found, expected, scale in (
        (positive, 325.0, 325.0),
        (p, apparent * np.cos(0.4), apparent),
        (q, apparent * np.sin(0.4), apparent),
        (by.tracked_frequency(segment, 50.0, "u", 1.0), hz, 50.0),
    ):
        off = (found[np.isfinite(found)] - expected) / scale
        assert len(off) > 59_000
        assert np.abs(off).max() < 2e-9
        assert abs(off.mean()) < 1e-11


@pytest.mark.parametrize(
    ("dt_s", "measured"),
    [
        (0.021, lambda by, segment: by.sequence_phasors(segment, "u", 50.0)),
        (0.021, lambda by, segment: by.mean_powers(segment, 50.0)),
        (0.05, lambda by, segment: by.tracked_frequency(segment, 50.0, "u", 1.0)),
    ],
)
def test_two_samples_a_cycle_are_too_few(dt_s, measured):
    """As the definition has it, in the same words."""
    segment = Segment(0.0, dt_s, {name: np.ones(9) for name in CHANNELS})
    with pytest.raises(MeasurementError) as expected:
        measured(BY_DEFINITION, segment)
    with pytest.raises(MeasurementError, match=str(expected.value)):
        measured(COMPILED, segment)


SAG = {"depth": 0.9, "phases": "ab"}
RAMP = {"kind": "frequency_ramp", "t_s": 0.1, "rate_hz_s": 1.0, "duration_s": 1.5}


@pytest.mark.parametrize(
    ("scenario", "trips"),
    [
        ({"sag": SAG, "duration_s": 0.5, "after_s": 6.0, "before_s": 2.0}, False),
        ({"sag": SAG, "duration_s": 0.5, "after_s": 6.0, "events": [RAMP]}, False),
        ({"sag": {"depth": 0.9}, "duration_s": 5.0, "after_s": 1.0}, True),
    ],
    ids=["steady", "a frequency that moves", "a trip"],
)
def test_evidence_is_the_same(scenario, trips):
    """Every series of a simulated record of several steps, also where its frequency moves, and where it trips."""
    asked, parameters = Scenario.model_validate(scenario), Parameters()
    waveforms, disturbance = simulate(asked, parameters), disturbance_asked(asked, NORMAL)
    assert len({segment.dt_s for segment in waveforms}) > 1
    assert (waveforms.tripped_at_s is not None) == trips
    expected, found = (
        Series(
            waveforms=waveforms,
            nominal=nominal_of(parameters, asked),
            disturbance=disturbance,
            instruments=instruments,
        )
        for instruments in (BY_DEFINITION, COMPILED)
    )
    for name in ("voltage_phasors_pu", "no_load_phasors_pu", "tracked_frequency_hz", "current_phase_pu"):
        same(getattr(found, name), getattr(expected, name), 50 if name.endswith("hz") else 1)
    for name in ("current_positive_pu", "current_negative_pu"):
        same(getattr(found, name), getattr(expected, name), 1)
    for kind in ("u", "u0"):
        same(found.phase_amplitudes_pu(kind), expected.phase_amplitudes_pu(kind), 1)
        for index in (0, 1, 2):
            same(found.sequence_pu(kind, index), expected.sequence_pu(kind, index), 1)
    for name in ("active_power_kw", "reactive_power_kvar", "half_cycle_kva"):
        same(getattr(found, name), getattr(expected, name), 500)
