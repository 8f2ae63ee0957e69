import numpy as np
import pytest

from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.scenario.parameters import Parameters
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.loop import CHANNELS
from pvlvrt_compliance.simulation.simulate import available_power_w, simulate

S, U, I = 500e3, np.sqrt(2) * 230, np.sqrt(2) * 500e3 / (3 * 230)  # noqa: E741 - the symbols of the nominal values


def test_the_record_is_uniform_and_complete(simulated):
    """One segment at the control step from 0 to the end of the scenario, all channels, finite."""
    run = simulated(0.9)
    assert tuple(run.samples.channels) == CHANNELS
    assert run.samples.t0_s == 0
    assert run.samples.dt_s == pytest.approx(40.9568e-6)
    assert run.samples.end_s == pytest.approx(run.scenario.end_s, abs=run.samples.dt_s)
    assert all(np.isfinite(x).all() for x in run.samples.channels.values())


@pytest.mark.parametrize(
    ("irradiance", "frequency_hz", "scr"),
    [
        (1000.0, 50.0, None),
        (1000.0, 60.0, None),
        (1000.0, 49.0, None),
        (800.0, 50.0, None),
        (200.0, 60.0, None),
        (1000.0, 50.0, 5.0),
    ],
)
def test_a_record_starts_in_the_steady_state(simulated, irradiance, frequency_hz, scr):
    """There is no transient in the first 0.2 s: power, DC voltage and the frequency estimate stand."""
    run = simulated(0.0, irradiance_w_m2=irradiance, frequency_hz=frequency_hz, scr=scr)
    start = run.samples.slice(0.0, 0.2)
    # Perturb and observe moves the DC voltage by half a volt every 40 ms below the limit.
    searching = irradiance < 985
    assert np.ptp(instantaneous_power(start).p) < (0.02 if searching else 1e-3) * S
    assert np.ptp(start["v_dc_v"]) < (2.5 if searching else 0.2)
    assert np.ptp(start["frequency_estimate_hz"]) < 1e-3
    assert start["frequency_estimate_hz"].mean() == pytest.approx(frequency_hz, abs=1e-3)


@pytest.mark.parametrize("irradiance", [200.0, 800.0])
def test_below_the_limit_it_starts_at_the_maximum_power_point(simulated, irradiance):
    """What reaches the grid before a sag is all that the array can give, but for the losses."""
    run = simulated(0.0, irradiance_w_m2=irradiance)
    available = available_power_w(run.scenario, Parameters())
    assert 0.985 * available < 1e3 * run.measured.before.active_power_kw < available


@pytest.mark.parametrize("phases", ["abc", "c"])
def test_energy_is_conserved(simulated, phases):
    """What the array gives is stored in link and filter, lost in the filter, or delivered, through a whole sag."""
    samples = simulated(0.9, phases).samples.slice(0.2, 1.0)
    dt = samples.dt_s
    i2 = sum(x**2 for x in samples.three_phase("i"))
    stored = 0.5 * 0.065 * samples["v_dc_v"] ** 2 + 0.5 * 0.15e-3 * i2
    array = np.trapezoid(samples["v_dc_v"] * samples["i_pv_a"], dx=dt)
    delivered = np.trapezoid(instantaneous_power(samples).p + 1e-3 * i2, dx=dt)
    assert array - delivered - (stored[-1] - stored[0]) == pytest.approx(0, abs=1e-3 * array)


@pytest.mark.parametrize(("step_us", "ratio"), [(10.2392, 4), (2.5598, 16)])
@pytest.mark.parametrize("phases", ["abc", "c"])
def test_the_plant_step_is_a_parameter(simulated, phases, step_us, ratio):
    """Half and twice the number of plant steps in a control period give the same waveforms within 0.5 % rms."""
    usual = simulated(0.9, phases).samples
    settings = (f"simulation.plant_step_us={step_us}", f"simulation.control_ratio={ratio}")
    other = simulated(0.9, phases, settings=settings).samples
    assert other.dt_s == pytest.approx(usual.dt_s)
    for kind, base in (("u", U), ("i", I)):
        difference = np.array(usual.three_phase(kind)) - np.array(other.three_phase(kind))
        assert np.sqrt((difference**2).mean()) < 0.005 * base
    assert np.sqrt(((usual["v_dc_v"] - other["v_dc_v"]) ** 2).mean()) < 0.005 * 1000


def test_another_control_period_works_too(simulated):
    """A control period of 32.768 us out of 5 steps still gives the powers of the sag."""
    run = simulated(0.9, settings=("simulation.plant_step_us=6.5536", "simulation.control_ratio=5"))
    assert run.samples.dt_s == pytest.approx(32.768e-6)
    assert run.measured.during.reactive_power_kvar == pytest.approx(50, abs=2)


@pytest.mark.parametrize(("two_phase", "sags"), [(False, ("a", "b", "c")), (True, ("bc", "ca", "ab"))])
def test_phases_are_alike(simulated, two_phase, sags):
    """The same sag one phase on, 120 degrees later on the wave, is the same record with its phases renamed."""
    runs = [
        simulated(0.9, phases, two_phase, point_on_wave_deg=120.0 * k, duration_s=0.3) for k, phases in enumerate(sags)
    ]
    first = runs[0].samples
    for k, run in enumerate(runs[1:], start=1):
        for kind, base in (("u", U), ("i", I)):
            expected, found = first.three_phase(kind), run.samples.three_phase(kind)
            assert np.allclose(np.roll(np.array(expected), k, axis=0), found, atol=1e-6 * base)
        assert np.allclose(first["v_dc_v"], run.samples["v_dc_v"], atol=1e-4)


DEEPEST = [(phases, False) for phases in ("abc", "a", "b", "c", "ab", "bc", "ca")] + [
    (pair, True) for pair in ("ab", "bc", "ca")
]


@pytest.mark.parametrize(("phases", "two_phase"), DEEPEST)
def test_the_deepest_sags_stay_finite(simulated, phases, two_phase):
    """A residual of zero, in any phases, makes no number that is not one, and the grid comes back to an intact run."""
    run = simulated(1.0, phases, two_phase, duration_s=0.15)
    assert all(np.isfinite(x).all() for x in run.samples.channels.values())
    assert run.samples["frequency_estimate_hz"].min() >= 40 - 1e-9
    assert run.samples["frequency_estimate_hz"].max() <= 70 + 1e-9
    assert run.samples["connected"].min() == 1
    assert run.measured.after.active_power_kw == pytest.approx(run.measured.before.active_power_kw, rel=0.01)


@pytest.mark.parametrize("temperature", [-20.0, 25.0, 85.0])
@pytest.mark.parametrize("irradiance", [0.0, 1500.0])
def test_any_weather_gives_a_record(simulated, irradiance, temperature):
    """Darkness, glare, frost and heat end in finite waveforms."""
    run = simulated(0.5, irradiance_w_m2=irradiance, cell_temperature_c=temperature, before_s=0.25, after_s=0.1)
    assert all(np.isfinite(x).all() for x in run.samples.channels.values())
    if irradiance == 0:
        assert abs(run.measured.before.active_power_kw) < 1


def test_a_number_that_is_none_ends_the_run_with_its_time(wrong_runs):
    """A plant that loses its DC voltage after 0.5 s is an error that says when."""
    scenario = Scenario(sag=Sag(depth=0.9), duration_s=0.309)
    with pytest.raises(SimulationError, match=r"finite at 0\.500\d s"):
        simulate(scenario, Parameters(), run=wrong_runs["not_a_number"])


def test_a_rebuilt_loop_is_the_loop(rebuild_loop, simulated):
    """Replacing a block by itself changes nothing: what differs with a wrong part comes from that part."""
    from pvlvrt_compliance.control.lvrt import lvrt_step

    usual = simulated(0.9)
    again = simulate(usual.scenario, Parameters(), run=rebuild_loop(lvrt_step=lvrt_step)).segments[0]
    for name, x in usual.samples.channels.items():
        assert np.allclose(x, again[name], rtol=1e-9, atol=1e-6), name
