"""What is given and does nothing in a run is told, and what does something is not."""

import pytest

from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameter_names
from pvlvrt_compliance.study.idle import NEEDS, OF_TESTS, idle_in_files
from pvlvrt_compliance.study.job import Asked, make_job

IEC = "iec61400-21"
OWN = {"controller": "examples/program-python/controller.py:X"}

NOISES = "sensors.voltage_noise_v, sensors.current_noise_a, sensors.dc_voltage_noise_v, sensors.pv_current_noise_a"

PAIRS = {
    "plant.dead_time_us=1": ("simulation.fidelity=switched", "simulation.fidelity=switched"),
    "plant.device_drop_v=1": ("simulation.fidelity=switched", "simulation.fidelity=switched"),
    "plant.device_resistance_ohm=1": ("simulation.fidelity=switched", "simulation.fidelity=switched"),
    "plant.switching_energy_mj=1": ("simulation.fidelity=switched", "simulation.fidelity=switched"),
    "sensors.voltage_range_v=700": ("sensors.adc_bits above 0", "sensors.adc_bits=12"),
    "sensors.current_range_a=700": ("sensors.adc_bits above 0", "sensors.adc_bits=12"),
    "sensors.dc_voltage_range_v=700": ("sensors.adc_bits above 0", "sensors.adc_bits=12"),
    "sensors.pv_current_range_a=700": ("sensors.adc_bits above 0", "sensors.adc_bits=12"),
    "sensors.noise_seed=1": (f"one of {NOISES} above 0", "sensors.dc_voltage_noise_v=1"),
    "controller.pll_bandwidth_hz=9": (
        "controller.synchronisation=srf-pll or controller.synchronisation=ddsrf-pll or"
        " controller.synchronisation=dsc-pll",
        "controller.synchronisation=ddsrf-pll",
    ),
    "controller.pll_damping=0.6": (
        "controller.synchronisation=srf-pll or controller.synchronisation=ddsrf-pll or"
        " controller.synchronisation=dsc-pll",
        "controller.synchronisation=dsc-pll",
    ),
    "controller.pnsd_notch_damping=0.6": ("controller.synchronisation=srf-pll", "controller.synchronisation=srf-pll"),
    "controller.ddsrf_filter_ratio=0.6": (
        "controller.synchronisation=ddsrf-pll",
        "controller.synchronisation=ddsrf-pll",
    ),
}
"""A parameter that does nothing by default: what it needs in words, and what gives that."""

LOST = {
    "controller.sogi_gain=1": ("controller.synchronisation=srf-pll", "msogi-fll or controller.synchronisation=dsogi"),
    "controller.fll_gain=9": ("controller.synchronisation=dsc-pll", "msogi-fll or controller.synchronisation=dsogi"),
    "simulation.record_settling=true": ("simulation.settling_s=0", "simulation.settling_s above 0"),
}
"""A parameter that does something by default: what takes that away, and what it then needs."""

OF_OWN = (
    "simulation.synchronising_s=0.3",
    "simulation.time_limit_s=9",
    "simulation.opening_limit_s=9",
    "simulation.memory_limit_mb=9",
    "simulation.output_limit_mb=9",
    "simulation.files_limit_mb=9",
    "simulation.files_limit=9",
    "simulation.processes_limit=9",
    "controller.hold=once",
)


def told(*settings, **asked):
    """What a job says of what does nothing; a sag of 50 % unless others are asked for."""
    job = make_job(Asked(**{"profiles": (IEC,), "sag": 0.5, "settings": settings} | asked))
    return [note for note in job.notes if "does nothing" in note]


@pytest.mark.parametrize("given", PAIRS)
def test_a_parameter_that_needs_another(given):
    """It is told with what it needs, and not any more once that is there."""
    words, needed = PAIRS[given]
    assert told(given) == [f"settings {given.partition('=')[0]} does nothing here: it needs {words}"]
    assert told(given, needed) == []


@pytest.mark.parametrize("given", LOST)
def test_a_parameter_that_another_takes_the_sense_of(given):
    """It does something by default."""
    other, words = LOST[given]
    assert told(given) == []
    (said,) = told(given, other)
    assert words in said


@pytest.mark.parametrize("given", OF_OWN)
def test_a_parameter_of_a_controller_of_ones_own(given):
    """With the bundled one it does nothing."""
    assert told(given) == [f"settings {given.partition('=')[0]} does nothing here: it needs a controller of your own"]
    assert told(given, **OWN) == []


def test_a_controller_of_ones_own_has_its_own_parameters():
    """What is called as one of the bundled controller's is none, and nothing is said of it."""
    assert told("controller.pll_damping=3", **OWN) == []


@pytest.mark.parametrize(
    "given", [{}, {"settings": ("controller.sogi_gain=1",)}, OWN, OWN | {"settings": ("controller.hold=once",)}]
)
def test_an_option_on_the_parameters_of_a_controller_of_ones_own(given):
    """Without one of them it does nothing, and names of the host are none of them."""
    words = "allow_out_of_range does nothing here: it needs a parameter of a controller of your own"
    (said,) = told(
        *given.get("settings", ()), **{"allow_out_of_range": True} | {k: given[k] for k in given if k != "settings"}
    )
    assert said == f"{words} (settings controller.NAME=VALUE)"
    assert told("controller.gain=1", allow_out_of_range=True, **OWN) == []


def test_waveforms_as_csv_where_none_is_kept():
    """What is kept is written so, and only what is."""
    (said,) = idle_in_files(csv=True, keeps_waveforms=False, spell=str)
    assert said == "csv does nothing here: it needs waveforms that are kept (waveforms all or failed)"
    assert not [*idle_in_files(csv=True, keeps_waveforms=True, spell=str)]
    assert not [*idle_in_files(csv=False, keeps_waveforms=False, spell=str)]


def test_the_table_is_whole():
    """Every parameter that a row needs exists, and each row of the table is tried above."""
    tried = {text.partition("=")[0] for text in (*PAIRS, *LOST, *OF_OWN)}
    assert tried == set(NEEDS)
    assert tried <= set(parameter_names())


@pytest.mark.parametrize(
    ("asked", "needed", "words"),
    [
        ({"xr": 3}, {"scr": 10}, "xr does nothing here: it needs a grid with a short-circuit ratio (scr)"),
        ({"transformer": "Dyn11", "sag": 0.0}, {"sag": 0.5}, "transformer does nothing here: it needs a sag"),
        ({"include_long": True}, {"sag": None, "profiles": ("nerc-prc-029",)}, "include_long does nothing here"),
    ],
)
def test_an_option_that_needs_a_test_of_some_kind(asked, needed, words):
    """It is told, and not any more once one of the tests is of the kind."""
    assert [said[: len(words)] for said in told(**asked)] == [words]
    assert told(**(asked | needed)) == []
    assert words.partition(" ")[0] in OF_TESTS


def test_the_ratio_of_a_profile_counts():
    """Where a test has a grid of its own, its X/R is what is given."""
    strong = Scenario(sag={"depth": 0.5}, duration_s=0.1, scr=5.0)
    assert OF_TESTS["xr"][1](type("Test", (), {"scenario": strong}))


def test_nothing_is_said_of_a_plain_run():
    """Nor of parameters that always do something."""
    assert told("controller.pr_integral_gain=0.2", "plant.filter_resistance_ohm=0.002", scr=10, xr=5) == []
