"""What each option does, seen in the files that the run leaves."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.scenario.sag import Sag

PAIRS = ("ab", "bc", "ca")


@pytest.mark.parametrize(
    ("options", "duration_s"),
    [
        (("--sag", "90%"), 0.309),
        (("--sag", "90%", "--phases", "c"), 1.262),
        (("--sag", "50%", "--phases", "c"), 1.473),
        (("--sag", "10%"), 0.5),
        (("--sag", "0%"), 0.5),
        (("--sag", "90%", "--duration", "200ms"), 0.2),
        (("--sag", "90%", "--duration", "0.2s"), 0.2),
    ],
)
def test_duration(judge, options, duration_s):
    """By default as long as the envelope demands at the sag's V+, 0.5 s where it demands nothing."""
    _, reports = judge(*options)
    assert reports.test["scenario"]["duration_s"] == pytest.approx(duration_s, abs=1e-3)


@pytest.mark.parametrize(("depth", "text"), [(0.9, "90%"), (0.9, "0.9"), (0.25, "25 %")])
def test_depth_as_percent_or_fraction(judge, depth, text):
    """90% and 0.9 are one depth."""
    _, reports = judge("--sag", text)
    assert reports.test["scenario"]["sag"]["depth"] == pytest.approx(depth)


def test_no_sag(judge):
    """0% is normal operation: about 500 kW, no reactive power, everything passes."""
    ended, reports = judge("--sag", "0%")
    assert ended.status == 0
    during = reports.test["measurements"]["during"]
    assert during["active_power_kw"] == pytest.approx(500, abs=5)
    assert during["reactive_power_kvar"] == pytest.approx(0, abs=8)


@pytest.mark.parametrize(
    ("options", "pair"),
    [
        (("--two-phase",), "bc"),
        (("--two-phase", "ca"), "ca"),
        (("--two-phase=ab",), "ab"),
        (("--two-phase", "--phases", "ca"), "ca"),
    ],
)
def test_two_phase(judge, options, pair):
    """The voltage between the two phases sags: V+ = (1 + r)/2, V- = (1 - r)/2; the pair is bc unless named."""
    ended, reports = judge("--sag", "60%", *options)
    assert ended.status == 0
    assert reports.test["scenario"]["sag"] == {
        "depth": 0.6,
        "phases": pair,
        "two_phase": True,
        "type": None,
        "angle_deg": 0.0,
    }
    during = reports.test["measurements"]["during"]
    assert during["voltage_positive_pu"] == pytest.approx(0.7, abs=1e-3)
    assert during["voltage_negative_pu"] == pytest.approx(0.3, abs=1e-3)


def _samples(reports):
    """Samples of a COMTRADE FLOAT32 file: analog channels by number, without a reader's help."""
    cfg = reports.folder / reports.test["waveforms"]
    analog = int(cfg.read_text("utf-8").splitlines()[1].split(",")[1].removesuffix("A"))
    row = np.dtype([("n", "<u4"), ("t", "<u4"), ("analog", "<f4", (analog,)), ("status", "<u2")])
    return np.fromfile(cfg.with_suffix(".dat"), row)["analog"]


DEEPEST = [("--phases", phases) for phases in ("abc", "a", "b", "c", *PAIRS)] + [("--two-phase", p) for p in PAIRS]


@pytest.mark.parametrize("options", DEEPEST, ids=" ".join)
def test_deepest_sags(judge, options):
    """A sag of 100 % ends with a verdict on every check, and no number that is not finite."""
    ended, reports = judge("--sag", "100%", *options)
    statuses = set(reports.verdicts[reports.test["id"]].values())
    assert len(reports.test["checks"]) == 7
    assert statuses <= {"pass", "fail", "not_applicable"}
    assert ended.status == (1 if "fail" in statuses else 0)
    samples = _samples(reports)
    assert len(samples) > 20_000
    assert np.isfinite(samples).all()


@pytest.mark.parametrize("options", DEEPEST, ids=" ".join)
def test_measured_sequences_are_those_of_the_sag(judge, options):
    """V+ and V- in the window `during` are the Fortescue components of the sag asked for."""
    flag, phases = options
    _, reports = judge("--sag", "40%", *options)
    expected = Sag(depth=0.4, phases=phases, two_phase=flag == "--two-phase").sequences_pu()
    during = reports.test["measurements"]["during"]
    assert during["voltage_positive_pu"] == pytest.approx(abs(expected.positive), abs=1e-3)
    assert during["voltage_negative_pu"] == pytest.approx(abs(expected.negative), abs=1e-3)


def test_grid_and_weather(judge):
    """Frequency, temperature, irradiance, strength and X/R of the grid, and the point on wave reach the scenario."""
    _, reports = judge(
        *("--sag", "20%", "--frequency", "60", "--temperature", "40", "--irradiance", "500"),
        *("--scr", "20", "--xr", "5", "--point-on-wave", "-90", "--transformer", "Dyn11"),
    )
    scenario = reports.test["scenario"]
    assert {name: scenario[name] for name in scenario if name not in {"sag", "duration_s", "before_s", "after_s"}} == {
        "frequency_hz": 60,
        "cell_temperature_c": 40,
        "irradiance_w_m2": 500,
        "scr": 20,
        "xr": 5,
        "point_on_wave_deg": -90,
        "vector_group": "Dyn11",
        "events": [],
        "reactive_power_pu": 0,
    }
    before = reports.test["measurements"]["before"]
    assert before["frequency_hz"] == pytest.approx(60, abs=0.01)
    assert before["active_power_kw"] < 270


@pytest.mark.parametrize(("degrees", "start_pu"), [(0, 1.0), (90, 0.0), (180, -1.0)])
def test_point_on_wave(judge, degrees, start_pu):
    """The sag begins where phase a's cosine has this angle."""
    _, reports = judge("--sag", "20%", "--point-on-wave", str(degrees))
    before = math.floor(reports.test["scenario"]["before_s"] / 40.9568e-6)  # last sample before the sag
    u0_a = _samples(reports)[before, 3]
    assert u0_a / (math.sqrt(2) * 230) == pytest.approx(start_pu, abs=0.02)


def test_test_patterns(judge):
    """Any of several shell patterns selects, whatever the case, in the order of the profile."""
    ended, reports = judge("--test", "vd6-partial-*", "--test", "VD2-full-1")
    assert list(reports.verdicts) == ["VD2-full-1", "VD6-partial-1", "VD6-partial-2"]
    assert ended.status == 0
    assert "PASS: 3 tests; checks: 21 pass" in ended.out


def test_options_hold_for_the_tests_of_a_profile(judge):
    """What describes the grid overrides every test of the profile."""
    _, reports = judge("--test", "VD2-full-1", "--frequency", "60")
    assert reports.test["measurements"]["before"]["frequency_hz"] == pytest.approx(60, abs=0.01)


def test_quiet(judge):
    """One line, with the verdict; the reports are written all the same."""
    ended, reports = judge("--sag", "90%", "--quiet")
    assert ended == (0, "PASS: 1 test; checks: 7 pass; 1 marginal\n", "")
    assert "report.html" in reports.files


def test_exit_zero(judge):
    """A failed check ends with 0 on request, and is reported as failed."""
    ended, reports = judge("--sag", "90%", "--set", "protection.overcurrent_pu=1.1", "--exit-zero")
    assert ended.status == 0
    assert reports.json["status"] == "fail"
    assert "exit status 0 by --exit-zero" in " ".join(ended.out.split())


def test_exit_zero_does_not_hide_wrong_usage(judge):
    """Wrong usage is no verdict: --exit-zero does not apply to it."""
    assert judge("--sag", "120%", "--exit-zero")[0].status == 2


def test_csv_on_request_only(judge):
    """Without --csv there is no CSV file."""
    _, reports = judge("--sag", "90%")
    assert {name.rpartition(".")[2] for name in reports.files} == {"html", "xml", "json", "cfg", "dat"}


def test_set(judge):
    """A parameter reaches the run and the report: without reactive power asked for, none is fed."""
    ended, reports = judge("--sag", "50%", "--set", "controller.reactive_plateau_pu=0")
    assert reports.json["provenance"]["parameters"]["controller"]["reactive_plateau_pu"] == 0
    assert reports.test["measurements"]["during"]["reactive_power_kvar"] == pytest.approx(0, abs=10)
    assert reports.verdicts[reports.test["id"]]["reactive_support"] == "fail"
    assert ended.status == 1


@pytest.mark.slow
def test_fidelity(judge):
    """--fidelity switched is simulation.fidelity: it stands in the report, and the losses show in the DC voltage."""
    _, reports = judge("--sag", "0%")
    averaged_v = reports.test["measurements"]["before"]["dc_voltage_mean_v"]
    for options in (("--fidelity", "switched"), ("--set", "simulation.fidelity=switched")):
        ended, reports = judge("--sag", "0%", *options)
        assert ended.status == 0
        assert reports.json["provenance"]["parameters"]["simulation"]["fidelity"] == "switched"
        switched_v = reports.test["measurements"]["before"]["dc_voltage_mean_v"]
        assert averaged_v - switched_v == pytest.approx(3.3, abs=0.3)


def test_simulation_rates_are_parameters(judge):
    """Half the plant step at twice the ratio is the same control period, and the same physics."""
    _, coarse = judge("--sag", "90%")
    before = coarse.test["measurements"]["during"]
    _, fine = judge("--sag", "90%", "--set", "simulation.plant_step_us=2.5598", "--set", "simulation.control_ratio=16")
    during = fine.test["measurements"]["during"]
    assert during["reactive_power_kvar"] == pytest.approx(before["reactive_power_kvar"], abs=0.5)
    assert during["dc_voltage_mean_v"] == pytest.approx(before["dc_voltage_mean_v"], abs=0.5)


@pytest.fixture
def own_profile(tmp_path):
    """A profile of the user's own that includes a shipped one and allows less ripple."""
    path = tmp_path / "my-code.toml"
    path.write_text(
        'schema_version = 1\nid = "my-code"\ntitle = "Mine"\ninclude = ["iec61400-21"]\n'
        "[requirements.dc_ripple]\n"
        'limit_percent = { value = 0.01, confidence = "chosen", source = "a stricter limit" }\n',
        "utf-8",
    )
    return path


def test_profile_by_path(command, reports, own_profile, tmp_path):
    """A TOML file of the user's own is judged against, and its numbers win over what it includes."""
    folder = tmp_path / "out"
    ended = command("--profile", own_profile, "--sag", "90%", "--phases", "c", "--output", folder)
    found = reports(folder)
    assert ended.status == 1
    assert found.json["profiles"][0]["id"] == "my-code"
    assert found.verdicts[found.test["id"]] == {
        "ride_through": "pass",
        "current_limit": "pass",
        "reactive_support": "pass",
        "active_power_support": "pass",
        "oscillation": "pass",
        "return_to_prefault": "pass",
        "dc_ripple": "fail",
    }


def test_profile_without_envelope(command, reports, tmp_path):
    """The reactive curve alone judges a sag, too."""
    ended = command("--profile", "spain-q-curve", "--sag", "90%", "--output", tmp_path)
    found = reports(tmp_path)
    assert found.test["scenario"]["duration_s"] == 0.5
    assert ended.status == 1  # nothing ever lets this inverter go, and its undervoltage relay does
    assert found.verdicts[found.test["id"]]["ride_through"] == "fail"


def test_list(command, tmp_path):
    """The selected tests are shown on stdout; nothing is simulated or written."""
    ended = command("--profile", "iec61400-21", "--list", "--output", tmp_path / "out")
    assert (ended.status, ended.err) == (0, "")
    lines = ended.out.splitlines()
    assert sum(line.startswith(("VD", "paper-")) for line in lines) == 27
    assert lines[-1] == "27 tests of iec61400-21"
    assert max(map(len, lines)) <= 80
    assert list(tmp_path.iterdir()) == []


def test_list_of_selected_tests(command):
    """--list goes with --test and with --sag."""
    ended = command("--profile", "iec61400-21", "--list", "--test", "VD3*")
    assert ended.out.splitlines()[-1] == "4 tests of iec61400-21"
    ended = command("--profile", "iec61400-21", "--list", "--sag", "50%", "--phases", "c")
    assert "phase c, 50 %" in ended.out
    assert ended.out.splitlines()[-1] == "1 test of iec61400-21"


def test_a_flag_can_be_taken_back(command):
    """The last of a flag and its opposite counts as typed: ``--no-list`` runs into what only a run needs."""
    assert "tests of iec61400-21" in command("--profile", "iec61400-21", "--list").out
    taken_back = command("--profile", "iec61400-21", "--list", "--no-list", "--format", "nothing")
    assert taken_back.status == 2
    assert "--format: no format 'nothing'" in taken_back.err
    given_again = command("--profile", "iec61400-21", "--no-list", "--list", "--no-fail-fast", "--list")
    assert "tests of iec61400-21" in given_again.out
