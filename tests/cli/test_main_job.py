"""The main job, `--profile iec61400-21 --sag 90%`, run as a program from an empty folder."""

import importlib.metadata
import json
import re

import comtrade
import jsonschema
import numpy as np
import pytest
from lxml import etree

CHECKS = [
    *("ride_through", "current_limit", "reactive_support", "active_power_support", "oscillation"),
    *("return_to_prefault", "dc_ripple"),
]

QUANTITIES = {
    *("voltage_positive_pu", "voltage_negative_pu", "active_power_kw", "reactive_power_kvar", "active_power_2f_kw"),
    *("current_phase_pu", "current_peak_pu", "dc_voltage_mean_v", "dc_voltage_2f_percent", "current_thd_percent"),
    "frequency_hz",
}

CHANNELS = [
    *("u_a_v", "u_b_v", "u_c_v", "u0_a_v", "u0_b_v", "u0_c_v", "i_a_a", "i_b_a", "i_c_a"),
    *("v_dc_v", "i_pv_a", "irradiance_w_m2"),
]


@pytest.fixture(scope="module")
def result(main_job):
    """The test in results.json."""
    return main_job.reports.test


@pytest.fixture(scope="module")
def record(main_job, result):
    """The record as the `comtrade` package reads it."""
    cfg = main_job.reports.folder / result["waveforms"]
    read = comtrade.Comtrade(use_double_precision=True)
    read.load(str(cfg), str(cfg.with_suffix(".dat")))
    return read


def test_passes_and_ends_with_0(main_job):
    """The paper's control rides through the sag."""
    assert main_job.ended.status == 0
    assert main_job.reports.json["status"] == "pass"


def test_table_is_on_stdout_and_nothing_on_stderr(main_job):
    """Data go to stdout; without a terminal there is no bar, no log and no colour."""
    assert main_job.ended.err == ""
    assert "\x1b" not in main_job.ended.out
    lines = main_job.ended.out.splitlines()
    assert lines[0].split() == ["check", "measured", "limit", "margin", "verdict", "confidence"]
    rows = {line.split()[0]: line for line in lines[2 : 2 + len(CHECKS)]}
    assert list(rows) == CHECKS
    assert all(" pass " in row and row.endswith("chosen") for row in map(str.strip, rows.values()))
    assert "PASS: 1 test; checks: 7 pass; 1 marginal" in lines


def test_readme_shows_what_the_command_prints(main_job, request):
    """The table of the README is the one of this version."""
    shown = (request.config.rootpath / "README.md").read_text("utf-8").split("```\n")
    table = next(block for block in shown if block.startswith("check "))
    printed = [line.rstrip() for line in main_job.ended.out.splitlines()]
    assert table.rstrip().splitlines() == printed[: len(table.rstrip().splitlines())]


def test_unverified_numbers_are_named_beside_the_verdict(main_job):
    """The envelope rests on a reading of a figure; the terminal says in one line how much is like that."""
    (said,) = [line for line in main_job.ended.out.splitlines() if line.startswith("Not verified: ")]
    assert re.search(r"\b\d+ inferred\b", said)
    assert said.endswith("; see the report, or -v")
    notes = main_job.reports.json["profiles"][0]["notes"]
    assert sum(map(int, re.findall(r"\d+", said))) == len(notes)


def test_files_of_the_output_folder(main_job, result):
    """Reports and waveforms are there, and nothing else."""
    stem = result["id"]
    assert main_job.reports.files == {
        *("report.html", "junit.xml", "results.json"),
        *(f"waveforms/{stem}.{extension}" for extension in ("cfg", "dat", "csv")),
    }


def test_results_conform_to_the_published_schema(main_job, command):
    """`pvlvrt-check schema` describes the file that the run wrote."""
    ended = command("schema")
    assert (ended.status, ended.err) == (0, "")
    schema = json.loads(ended.out)
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(main_job.reports.json)


@pytest.mark.parametrize(
    "change",
    [
        {"status": "passed"},
        {"tests": [{"id": "x", "status": "pass", "checks": [{"check": "y"}]}]},
        {"tests": [{"id": "x", "status": "pass", "duration_s": "long"}]},
    ],
    ids=["verdict", "check without verdict", "number"],
)
def test_schema_refuses_what_is_no_result(main_job, command, change):
    """A schema that accepts everything would prove nothing."""
    schema = json.loads(command("schema").out)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(main_job.reports.json | change, schema, jsonschema.Draft202012Validator)


def test_schema_allows_what_a_later_version_adds(main_job, command):
    """Keys are only added to: whoever reads goes by those he knows."""
    schema = json.loads(command("schema").out)
    jsonschema.validate(main_job.reports.json | {"surprise": 1}, schema, jsonschema.Draft202012Validator)


def test_keys_that_other_programs_rely_on(main_job, result):
    """Top level, test, check and windows have the keys of the published interface."""
    top = {"schema_version", "run_id", "status", "allow_unjudged", "report", "profiles", "provenance", "tests"}
    top |= {"baseline", "ended_at", "interrupted"}
    assert set(main_job.reports.json) == top
    assert result.keys() >= {"id", "scenario", "status", "checks", "waveforms", "measurements"}
    assert [check["check"] for check in result["checks"]] == CHECKS
    for check in result["checks"]:
        assert set(check) == {
            *("check", "status", "measured", "limit", "margin", "unit", "at_s", "clause", "confidence", "message"),
            *("bound", "tolerance", "uncertainty", "stretch", "marginal"),
            *("known", "known_reason", "worse"),
        }
    measured = result["measurements"]
    assert set(measured) == {"before", "during", "after", "controller"}
    for window in ("before", "during", "after"):
        assert set(measured[window]) == QUANTITIES | {"start_s", "end_s"}
        assert len(measured[window]["current_phase_pu"]) == 3
    assert set(measured["controller"]) == {"v_fault_pu", "q_ref_kvar", "p_ref_kw"}


def test_windows_of_the_measurements(result):
    """Ten cycles before the start, whole cycles well inside the sag, and the last ten cycles of the record."""
    start = result["scenario"]["before_s"]
    clear = start + result["scenario"]["duration_s"]
    windows = {name: (w["start_s"], w["end_s"]) for name, w in result["measurements"].items() if name != "controller"}
    assert windows["before"] == pytest.approx((start - 0.22, start - 0.02), abs=1e-4)
    assert windows["during"][0] >= start + 0.1 - 1e-4
    assert windows["during"][1] <= clear - 0.02 + 1e-4
    cycles = (windows["during"][1] - windows["during"][0]) / 0.02
    assert cycles == pytest.approx(9, abs=1e-4)  # 0.309 s less 0.12 s, in whole cycles
    assert windows["after"][1] - windows["after"][0] == pytest.approx(0.2, abs=1e-6)


def test_measured_values_are_those_of_the_paper(result):
    """V_fault 0.1 pu: 50 kvar and no active power, nominal current, and 1003 V on the DC link."""
    during = result["measurements"]["during"]
    assert during["voltage_positive_pu"] == pytest.approx(0.1, abs=1e-3)
    assert during["reactive_power_kvar"] == pytest.approx(50, abs=2)
    assert during["active_power_kw"] == pytest.approx(0, abs=2)
    assert during["current_phase_pu"] == pytest.approx([1, 1, 1], abs=0.02)
    assert during["dc_voltage_mean_v"] == pytest.approx(1003, abs=5)
    assert result["measurements"]["controller"]["v_fault_pu"] == pytest.approx(0.1, abs=2e-3)


def test_provenance_allows_to_repeat_the_run(main_job):
    """Versions, digests, all parameters and the command as it was typed are in the file."""
    origin = main_job.reports.json["provenance"]
    assert origin["command"] == "pvlvrt-check --profile iec61400-21 --sag 90% --csv"
    assert origin["versions"]["pvlvrt-compliance"] == importlib.metadata.version("pvlvrt-compliance")
    assert origin["parameters"]["controller"]["dc_proportional_gain_w_per_v"] == 3977.5
    assert origin["profile_digest"] == main_job.reports.json["profiles"][0]["digest"]
    assert origin["controller_digest"]


def test_junit_file_is_valid(main_job, request):
    """`junit.xml` validates against junit-10.xsd and holds a case a check."""
    schema = etree.XMLSchema(etree.parse(request.config.rootpath / "tests" / "schemas" / "junit-10.xsd"))
    schema.assertValid(etree.parse(main_job.reports.folder / "junit.xml"))
    cases = main_job.reports.junit.findall(".//testcase")
    assert [case.get("name") for case in cases] == CHECKS
    assert {case.get("classname") for case in cases} == {f"iec61400-21.{main_job.reports.test['id']}"}


def test_comtrade_file_has_the_channels_of_the_interface(record):
    """Another program's reader finds every channel by name, with its unit."""
    assert record.analog_channel_ids[: len(CHANNELS)] == CHANNELS
    assert "connected" in record.status_channel_ids
    units = {channel.name: channel.uu for channel in record.cfg.analog_channels}
    assert (units["u_a_v"], units["i_a_a"], units["v_dc_v"]) == ("V", "A", "V")
    assert record.frequency == 50


def test_comtrade_file_shows_the_sag(record, result):
    """0.9 of the amplitude is lost from the trigger to clearing, and the breaker stays closed."""
    t = np.asarray(record.time)
    start = result["scenario"]["before_s"]
    clear = start + result["scenario"]["duration_s"]
    u0_a = np.asarray(record.analog[CHANNELS.index("u0_a_v")])
    amplitude = np.sqrt(2) * 230
    assert np.abs(u0_a[t < start - 1e-4]).max() == pytest.approx(amplitude, rel=1e-3)
    assert np.abs(u0_a[(t > start + 1e-4) & (t < clear - 1e-4)]).max() == pytest.approx(0.1 * amplitude, rel=1e-3)
    assert np.abs(u0_a[t > clear + 1e-4]).max() == pytest.approx(amplitude, rel=1e-3)
    assert set(record.status[record.status_channel_ids.index("connected")]) == {1}
    assert record.trigger_time == pytest.approx(start, abs=1e-6)


def test_csv_file_is_the_same_record(main_job, record, result):
    """Both files of one run hold the same samples."""
    csv = (main_job.reports.folder / result["waveforms"]).with_suffix(".csv")
    with csv.open(encoding="ascii") as file:
        header = file.readline().strip().split(",")
        rows = np.loadtxt([line for _, line in zip(range(200), file, strict=False)], delimiter=",")
    assert header[0] == "t_s"
    assert sorted(header[1:]) == sorted([*record.analog_channel_ids, *record.status_channel_ids])
    assert rows[:, 0] == pytest.approx(np.asarray(record.time[:200]), abs=1e-6)
    for name in CHANNELS:
        column = np.asarray(record.analog[record.analog_channel_ids.index(name)][:200])
        assert rows[:, header.index(name)] == pytest.approx(column, rel=1e-6, abs=1e-5), name


def test_report_is_one_file_without_network(main_job):
    """Verdict at the top, the figure's data inside, and nothing that is fetched from elsewhere."""
    page = main_job.reports.page
    assert page.get_element_by_id("verdict").get("data-status") == "pass"
    fetched = page.xpath("//script/@src | //link/@href | //img/@src")
    assert [place for place in fetched if not place.startswith("data:")] == []
