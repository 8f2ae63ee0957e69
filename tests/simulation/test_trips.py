from types import SimpleNamespace

import numpy as np
import pytest

from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.plant.protection import (
    BY_CONTROLLER,
    DC_OVERVOLTAGE,
    FREQUENCY,
    NO_TRIP,
    OVERCURRENT,
    UNDERVOLTAGE,
)
from pvlvrt_compliance.scenario.events import FrequencyRamp
from pvlvrt_compliance.simulation.loop import is_finite
from pvlvrt_compliance.waveforms import trip_causes
from pvlvrt_compliance.waveforms.trip_causes import TRIP_CAUSES, in_words


def opened_s(run) -> float | None:
    """When the breaker opened, from the start of the sag (s); None when it stayed closed."""
    open_at = np.flatnonzero(run.samples["connected"] < 0.5)
    return float(run.samples.t_s[open_at[0]] - run.scenario.start_s) if len(open_at) else None


def test_a_sag_beyond_the_envelope_disconnects(simulated):
    """Three-phase 90 % for 0.5 s: the breaker opens between 0.309 s and 0.41 s after the start, for good."""
    run = simulated(0.9, duration_s=0.5)
    assert 0.309 < opened_s(run) < 0.41
    assert run.samples["connected"][-1] == 0
    assert abs(instantaneous_power(run.samples).p[-100:]).max() < 1


@pytest.mark.parametrize(
    ("depth", "phases", "duration_s"), [(0.9, "abc", 0.309), (0.9, "c", 1.262), (0.5, "c", 1.473), (0.5, "abc", 0.944)]
)
def test_clearing_on_the_envelope_stays_connected(simulated, depth, phases, duration_s):
    """A sag that ends exactly where the curve reaches its V+ is ridden through."""
    assert opened_s(simulated(depth, phases, duration_s=duration_s)) is None


def test_a_trip_blocks_the_bridge_and_then_opens_the_breaker(simulated):
    """An overcurrent relay set too low: the current ends at once, the breaker opens, the link goes to open circuit."""
    run = simulated(0.9, settings=("protection.overcurrent_pu=1.2",))
    samples = run.samples
    at_s = opened_s(run)
    assert 0 < at_s < 0.02
    after = samples.slice(run.scenario.start_s + at_s, run.scenario.end_s)
    assert max(np.abs(x).max() for x in after.three_phase("i")) == 0
    assert after["connected"].max() == 0
    assert after["v_dc_v"][-1] == pytest.approx(1003.2, abs=0.5)
    peak = np.sqrt(2) * 500e3 / (3 * 230)
    # The relay looks at every plant step, the record at every eighth.
    assert max(np.abs(x).max() for x in samples.three_phase("i")) / peak == pytest.approx(1.2, abs=0.05)


def test_without_current_the_terminals_show_the_source(simulated):
    """Behind a weak grid, an open breaker leaves the voltage of the source at the terminals."""
    run = simulated(0.9, settings=("protection.overcurrent_pu=1.1",), scr=10.0)
    after = run.samples.slice(run.scenario.start_s + opened_s(run) + 0.001, run.scenario.end_s)
    assert np.allclose(after.three_phase("u"), after.three_phase("u0"), atol=1e-9)


@pytest.mark.parametrize(("temperature", "trips"), [(-15.0, True), (-5.0, True), (5.0, False), (25.0, False)])
def test_frost_trips_the_dc_overvoltage_relay_in_a_deep_sag(simulated, temperature, trips):
    """Below about 0 degrees C the open-circuit voltage passes 1100 V, where a deep sag drives the link to."""
    run = simulated(0.9, cell_temperature_c=temperature)
    assert (opened_s(run) is not None) == trips
    if trips:
        assert run.samples["v_dc_v"].max() > 1100


def test_frequency_relay_in_a_run(simulated):
    """A grid at 45.5 Hz is within the band; with the band narrowed to 46 Hz it opens the breaker before the sag."""
    assert opened_s(simulated(0.0, frequency_hz=45.5)) is None
    narrow = simulated(0.0, frequency_hz=45.5, settings=("protection.frequency_min_hz=46",))
    assert narrow.samples["connected"].max() == 0


def test_settings_of_the_relays_do_not_touch_a_run_within_them(simulated):
    """Relays that do not trip change nothing."""
    usual = simulated(0.9)
    wider = simulated(0.9, settings=("protection.overcurrent_pu=3.0", "protection.dc_overvoltage_v=2000"))
    for name, x in usual.samples.channels.items():
        assert np.array_equal(x, wider.samples[name]), name


FALLING = {"depth": 0.0, "duration_s": 2.0, "events": (FrequencyRamp(t_s=0.0, rate_hz_s=-1.0, duration_s=1.0),)}


@pytest.mark.parametrize("fidelity", ["averaged", pytest.param("switched", marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    ("settings", "fields", "cause"),
    [
        (("protection.overcurrent_pu=1.2",), {}, "over-current relay of the plant"),
        ((), {"cell_temperature_c": -15.0}, "DC over-voltage relay of the plant"),
        ((), {"duration_s": 0.5}, "under-voltage relay of the plant"),
        (("protection.frequency_min_hz=49.5",), FALLING, "frequency relay of the plant"),
        ((), {}, None),
    ],
)
def test_the_record_says_what_opened_the_breaker(simulated, fidelity, settings, fields, cause):
    """`trip_cause` is 0 up to the trip and the relay's code from then on, before the breaker has opened."""
    settings = (*settings, f"simulation.fidelity={fidelity}")
    samples = simulated(settings=settings, **{"depth": 0.9, **fields}).samples
    codes = samples["trip_cause"]
    assert codes[0] == 0
    assert set(np.unique(codes)) <= {0.0, codes[-1]}
    assert (in_words(int(codes[-1])) if codes[-1] else None) == cause
    if cause:
        assert np.flatnonzero(codes > 0)[0] <= np.flatnonzero(samples["connected"] < 0.5)[0]


def test_every_code_of_the_relays_has_words():
    """The words of the record and the codes of the plant are of one length and order."""
    codes = (NO_TRIP, OVERCURRENT, DC_OVERVOLTAGE, UNDERVOLTAGE, FREQUENCY, BY_CONTROLLER)
    assert codes == tuple(range(len(TRIP_CAUSES)))
    first = [in_words(code).split()[0] for code in codes]
    assert first == ["none", "over-current", "DC", "under-voltage", "frequency", "controller"]
    assert DC_OVERVOLTAGE == trip_causes.DC_OVERVOLTAGE
    assert in_words(77) == "cause 77"


@pytest.mark.parametrize(
    ("trip", "spoiled", "goes_on"), [(0, "", True), (0, "m", False), (3, "m", True), (3, "i", False)]
)
def test_only_the_plant_has_to_stay_finite_after_a_trip(trip, spoiled, goes_on):
    """A controller that loses itself ends a run before a trip; after it no number of the plant depends on it."""
    plant = {"v_dc": 800.0, "i": 0j, "i_pv": 0.0, "trip": trip}
    signals = {"m": 0j, "w": 314.0, "P_ref": 0.0, "v_ref": 800.0}
    for numbers in (plant, signals):
        numbers |= {name: complex(np.nan, 0.0) for name in numbers if name == spoiled}
    judged = getattr(is_finite, "py_func", is_finite)(SimpleNamespace(**plant), SimpleNamespace(**signals))
    assert judged == goes_on
