"""A record that is there already is judged as it was when it was made."""

import pytest

from pvlvrt_compliance import (
    MeasurementError,
    Scenario,
    Segment,
    UsageError,
    Waveforms,
    check,
    evaluate,
    load_profile,
    read_waveforms,
)

IEC = "iec61400-21"


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Folder with the record of a test, as COMTRADE and CSV, and the results of its run."""
    folder = tmp_path_factory.mktemp("written") / "out"
    results = check(IEC, tests="VD3-full-1", output=folder, csv=True)
    return folder / "waveforms", results


@pytest.mark.parametrize("name", ["VD3-full-1.csv", "VD3-full-1.cfg"])
def test_a_record_is_judged_as_it_was(written, name):
    """By the test that was applied, verdict for verdict; a file holds fewer digits than the record."""
    folder, results = written
    record = folder / name
    again = evaluate(IEC, record, test="vd3-FULL-1", available_power_kw=results.tests[0].available_power_kw)
    for found, was in zip(again.tests[0].checks, results.tests[0].checks, strict=True):
        assert (found.check, found.status) == (was.check, was.status)
        assert found.limit == pytest.approx(was.limit, rel=1e-6)
        assert found.margin == pytest.approx(was.margin, rel=1e-4, abs=2e-4)
    assert again.provenance["record"] == str(record)
    assert again.tests[0].scenario == results.tests[0].scenario
    assert evaluate(load_profile(IEC), read_waveforms(record), test="VD3-full-1").tests[0].checks


def test_what_the_grid_did_is_found(written):
    """Without a test, the sag is found where it was, and judged."""
    folder, results = written
    (found,) = evaluate(IEC, str(folder / "VD3-full-1.csv")).tests
    (was,) = results.tests
    assert (found.id, found.scenario, found.disturbance.origin) == ("VD3-full-1", {}, "found")
    assert found.disturbance.start_s == pytest.approx(was.disturbance.start_s, abs=0.021)
    assert found.disturbance.end_s == pytest.approx(was.disturbance.end_s, abs=0.021)
    assert {c.check: c.status for c in found.checks} == {c.check: c.status for c in was.checks}


def test_a_scenario_says_what_was_applied(written):
    """Times count from the start of the record, as in the test that it was."""
    folder, results = written
    scenario = Scenario.model_validate(results.tests[0].scenario)
    (found,) = evaluate(IEC, folder / "VD3-full-1.csv", test=scenario).tests
    assert [c.status for c in found.checks] == [c.status for c in results.tests[0].checks]
    assert found.title == scenario.describe()


def test_the_digest_of_a_record(written):
    """It is that of the samples, so that two records are not taken for one."""
    waveforms = read_waveforms(written[0] / "VD3-full-1.csv")
    (segment,) = waveforms
    changed = Waveforms(
        (Segment(segment.t0_s, segment.dt_s, {**segment.channels, "v_dc_v": segment["v_dc_v"] + 1e-9}),)
    )
    digests = [
        evaluate(IEC, record, test="VD3-full-1").provenance["record_digest"]
        for record in (waveforms, changed, waveforms)
    ]
    assert digests[0] == digests[2] != digests[1]


def test_what_evaluate_refuses(written, tmp_path):
    """Each with what is allowed."""
    record = written[0] / "VD3-full-1.csv"
    with pytest.raises(
        UsageError, match=r'test VD3-ful-1: iec61400-21 has no test of this name; did you mean "VD3-full-1"'
    ):
        evaluate(IEC, record, test="VD3-ful-1")
    with pytest.raises(UsageError, match="cannot be read as a recording"):
        evaluate(IEC, tmp_path / "absent.csv")
    with pytest.raises(UsageError, match="unknown profile"):
        evaluate("iec", record)
    still = {f"u_{p}_v": read_waveforms(record).segments[0][f"u_{p}_v"][:2000] for p in "abc"}
    with pytest.raises(MeasurementError, match="the record holds no disturbance"):
        evaluate(IEC, Waveforms((Segment(0.0, 4e-5, still),)))
