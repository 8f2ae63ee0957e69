"""The switched inverter beside the averaged one: equal in the mean when ideal, and what dead time and losses change."""

import math
import tomllib
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.measure.windows import standard_windows
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.columns import I as CURRENTS
from pvlvrt_compliance.simulation.columns import put_phases, record_plant
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.space_vectors import clarke
from pvlvrt_compliance.study.run import run_test

SWITCHED = ("simulation.fidelity=switched",)
LOSSLESS = ("plant.device_drop_v=0", "plant.device_resistance_ohm=0", "plant.switching_energy_mj=0")
IDEAL = (*SWITCHED, "plant.dead_time_us=0", *LOSSLESS)
I, U = math.sqrt(2) * 500e3 / 690, math.sqrt(2) * 230  # noqa: E741 - the symbols of the nominal values
V_DROP, R_ON, R_FILTER, T_LOSS, T = 0.22, 0.5e-3, 1e-3, 24.76e-3 / 800e3, 40.9568e-6


def record_means(row, x, y, G):
    """Record the mean current of the period that has ended in the place of the sample."""
    record_plant(row, x, y, G)
    put_phases(row, CURRENTS, x.mean.i, 0.0)


@pytest.fixture(scope="session")
def recording_means(rebuild_loop):
    """Loop that records the mean current of each period."""
    return rebuild_loop(record_plant=record_means)


def rms(x) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(x))))


def golden_cases():
    """Scenario and settings of every golden case."""
    for file in sorted((Path(__file__).parents[1] / "golden").glob("*/input.toml")):
        table = tomllib.loads(file.read_text("utf-8"))
        settings = tuple(table.get("parameters", ()))
        yield pytest.param(Scenario.model_validate(table["scenario"]), settings, id=file.parent.name)


def sags():
    """The paper's three sags at both frequencies and two irradiances."""
    for depth, phases, duration_s in ((0.9, "abc", 0.309), (0.9, "c", 1.262), (0.5, "c", 1.473)):
        sag = Sag.model_validate({"depth": depth, "phases": phases})
        for frequency_hz, irradiance in product((50.0, 60.0), (1000.0, 800.0)):
            scenario = Scenario(sag=sag, duration_s=duration_s, frequency_hz=frequency_hz, irradiance_w_m2=irradiance)
            yield pytest.param(scenario, (), id=f"{sag.describe()}, {frequency_hz:g} Hz, {irradiance:g} W/m2")


@pytest.mark.parametrize(("scenario", "settings"), [*golden_cases(), *sags()])
def test_ideal_switching_agrees_with_the_average(recording_means, scenario, settings):
    """Without dead time and drops, one-period means of the currents and v_DC agree within 1 % of nominal, rms.

    They agree within 0.1 %, and that is asked of them: the 1 % is for what dead time and losses add.
    """
    averaged = simulate(scenario, parameters_from(settings)).segments[0]
    switched = simulate(scenario, parameters_from((*settings, *IDEAL)), run=recording_means).segments[0]
    for window in standard_windows(scenario.start_s, scenario.clear_s, averaged.end_s, scenario.frequency_hz):
        if window is not None:
            samples, means = averaged.slice(*window), switched.slice(*window)
            for x, mean in zip(samples.three_phase("i"), means.three_phase("i"), strict=True):
                assert rms(0.5 * (x[:-1] + x[1:]) - mean[1:]) < 0.001 * I
            assert rms(samples["v_dc_v"] - means["v_dc_v"]) < 0.001 * 1000


def test_the_sampled_current_is_the_mean(simulated, recording_means):
    """Where the carrier turns, the ripple of symmetrical pulses passes its mean: sampling there needs no filter."""
    run = simulated(0.9, "c", duration_s=1.262, settings=IDEAL)
    means = simulate(run.scenario, parameters_from(IDEAL), run=recording_means).segments[0]
    for x, mean in zip(run.samples.three_phase("i"), means.three_phase("i"), strict=True):
        assert rms(0.5 * (x[:-1] + x[1:]) - mean[1:]) < 0.002 * I


def device_losses(samples) -> float:
    """Mean losses of the devices (W), in closed form: drop, resistance, and one pair of commutations a period."""
    i = np.array(samples.three_phase("i"))
    conduction = V_DROP * np.abs(i) + R_ON * i**2
    return (conduction + T_LOSS / T * samples["v_dc_v"] * np.abs(i)).sum(axis=0).mean()


def lost_w(means) -> float:
    """Mean power that the array gives and neither link nor filter nor grid takes (W); currents are period means."""
    i = [x[1:] for x in means.three_phase("i")]
    u = [0.5 * (x[:-1] + x[1:]) for x in means.three_phase("u")]
    array = means["v_dc_v"] * means["i_pv_a"]
    stored = 0.5 * 0.065 * means["v_dc_v"] ** 2 + 0.5 * 0.15e-3 * sum(x**2 for x in means.three_phase("i"))
    taken = sum(x * y + R_FILTER * y**2 for x, y in zip(u, i, strict=True))
    return (0.5 * (array[:-1] + array[1:]) - taken - np.diff(stored) / T).mean()


def test_losses_at_nominal_are_those_of_the_module(simulated, recording_means):
    """At 1000 W/m2 the devices lose 2436 W, half in conduction and half in switching; ideal ones nothing.

    The array is sampled once a period, on its ripple, which is worth some 30 W.
    """
    scenario = simulated(0.0).scenario
    for settings, expected in ((SWITCHED, 2436), ((*SWITCHED, "plant.switching_energy_mj=0"), 1218), (IDEAL, 0)):
        means = simulate(scenario, parameters_from(settings), run=recording_means).segments[0].slice(0.08, 0.28)
        assert lost_w(means) == pytest.approx(expected, rel=0.02, abs=40)


@pytest.mark.parametrize("phases", ["abc", "c"])
def test_energy_is_conserved_with_losses(simulated, recording_means, phases):
    """What the array gives is stored, lost in filter and devices, or delivered, through a whole sag, within 2e-4."""
    scenario = simulated(0.9, phases).scenario
    means = simulate(scenario, parameters_from(SWITCHED), run=recording_means).segments[0].slice(0.2, 1.0)
    array = (means["v_dc_v"] * means["i_pv_a"]).mean()
    assert lost_w(means) == pytest.approx(device_losses(means), abs=2e-4 * array)


def test_the_controller_makes_up_for_dead_time(simulated):
    """Dead time takes 10 V a phase against the current; the modulating signal grows by it, the current hardly moves."""
    dead = (*SWITCHED, *LOSSLESS, "plant.dead_time_us=0.5")
    run, ideal = (simulated(0.0, settings=x) for x in (dead, IDEAL))
    a, b = (x.samples.slice(0.08, 0.28) for x in (run, ideal))
    m = [x["m_alpha"] + 1j * x["m_beta"] for x in (a, b)]
    i = clarke(*a.three_phase("i"))
    # The fundamental of a square wave is 4/pi of it; along the current, per volt of 2/3 v_DC m.
    added = np.mean((m[0] - m[1]) * i.conj() / np.abs(i)).real * 2 / 3 * 834
    assert added == pytest.approx(math.sqrt(1.5) * 4 / math.pi * 834 * 0.5e-6 / T, rel=0.05)
    assert rms(a["i_a_a"] - b["i_a_a"]) < 0.01 * I


@pytest.mark.parametrize("scr", [20.0, 5.0])
def test_behind_a_grid_impedance_sensors_see_the_mean(simulated, scr):
    """The voltage at the terminals carries steps of the bridge; what is sampled is their mean, as when averaged."""
    runs = [simulated(0.9, scr=scr, settings=x) for x in ((), IDEAL)]
    for start_s, stop_s in ((0.08, 0.28), (0.4, 0.58)):
        a, b = (run.samples.slice(start_s, stop_s) for run in runs)
        for x, y in zip(a.three_phase("u"), b.three_phase("u"), strict=True):
            assert rms(x - y) < 0.01 * U


def test_the_paper_s_sags_pass_every_check():
    """Dead time, drops and losses change no verdict of the paper's three sags."""
    profile = load_profile("iec61400-21")
    for test in profile.tests():
        if test.id.startswith("paper"):
            result = run_test(profile, test, parameters_from(SWITCHED)).result
            assert {check.check: check.status for check in result.checks if check.status != "pass"} == {}, test.id


def test_a_trip_ends_the_switching(simulated):
    """After an overcurrent trip the diodes take over, the current ends and the breaker opens, as when averaged."""
    run = simulated(0.9, settings=(*SWITCHED, "protection.overcurrent_pu=1.2"))
    assert run.samples["connected"][-1] == 0
    assert max(np.abs(x[-1]) for x in run.samples.three_phase("i")) == 0
    assert run.samples["v_dc_v"][-1] == pytest.approx(1003.2, abs=0.5)
