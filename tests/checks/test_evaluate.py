"""What a test result carries, and checks from other packages."""

import gc
import math
import weakref
from pathlib import Path

import numpy as np
import pytest
from demands import CONTROL_STEP_S

from pvlvrt_compliance.checks.evaluate import errored, evaluate, evidence_of
from pvlvrt_compliance.checks.summary import summarise
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

KINDS = [
    "ride_through",
    "current_limit",
    "reactive_support",
    "active_power_support",
    "oscillation",
    "return_to_prefault",
    "dc_ripple",
]


def test_flawless_record_passes(bench, iec):
    """A record that meets every demand passes them all, each with clause, mark, margin and instant."""
    result = bench(q_sag_kvar=250).result()
    assert [check.check for check in result.checks] == KINDS
    assert result.status is Status.PASS
    for check in result.checks:
        assert check.status is Status.PASS
        assert check.clause
        assert check.confidence == "chosen"
        assert check.margin >= 0
        assert 0 <= check.at_s <= result.duration_s
    assert (result.profile, result.scenario["sag"]["depth"]) == (iec.id, 0.5)
    assert result.duration_s == pytest.approx(1.7, abs=1e-3)
    assert result.measurements.during.voltage_positive_pu == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(
    ("kind", "fault"),
    [
        ("ride_through", {"recovers_after_s": 1.05}),
        ("current_limit", {"p_after_kw": 520.0}),
        ("reactive_support", {"q_sag_kvar": 200.0}),
        ("dc_ripple", {"dc_ripple_percent": 0.2}),
    ],
)
def test_one_fault_fails_one_check(bench, kind, fault):
    """Each wrong record fails the check it should and no other, and the test with it."""
    result = bench(**({"q_sag_kvar": 250.0} | fault)).result()
    assert [check.check for check in result.checks if check.status is not Status.PASS] == [kind]
    assert result.status is Status.FAIL


@pytest.mark.parametrize(
    ("missing", "kinds"),
    [
        ("connected", ["ride_through"]),
        ("v_dc_v", ["dc_ripple"]),
        ("u0_b_v", KINDS),
        ("i_c_a", KINDS),
        ("u_a_v", KINDS),
    ],
)
def test_missing_channel(bench, missing, kinds):
    """A check whose channel is missing is not evaluated, with the channel named; the others go on."""
    result = bench(q_sag_kvar=250, without=(missing,)).result()
    lost = [check for check in result.checks if check.status is Status.NOT_EVALUATED]
    assert [check.check for check in lost] == kinds
    assert all(check.message for check in lost)
    assert result.status is Status.NOT_EVALUATED


@pytest.mark.parametrize("channel", ["connected", "v_dc_v", "u_a_v", "u0_c_v", "i_b_a"])
@pytest.mark.parametrize("at_s", [0.15, 0.5, 1.5])
def test_samples_that_are_no_numbers(bench, channel, at_s):
    """One sample that is not finite never crashes, and never passes a check that needs it."""
    result = bench(q_sag_kvar=250, spoiled={channel: at_s}).result()
    needs = {"connected": "ride_through", "u_a_v": "ride_through", "v_dc_v": "dc_ripple"}.get(channel, "current_limit")
    harmless = {("v_dc_v", 0.15), ("v_dc_v", 1.5), ("u0_c_v", 1.5)}
    check = next(check for check in result.checks if check.check == needs)
    assert check.status is (Status.PASS if (channel, at_s) in harmless else Status.NOT_EVALUATED)


def test_each_stretch_of_several_is_measured(bench):
    """A sag within a sag: each stretch has a window of its own, in which nothing of another is."""
    inner = {"kind": "sag", "t_s": 0.2, "duration_s": 0.15, "sag": Sag(depth=0.8)}
    stretches = bench(depth=0.3, duration_s=0.6, scenario={"events": [inner]}).result().measurements.stretches
    assert [round(part.begin_s, 6) for part in stretches] == [0.3, 0.5, 0.65, 0.9]
    assert [part.window.voltage_positive_pu for part in stretches] == pytest.approx([0.7, 0.2, 0.7, 1.0], abs=1e-6)
    assert bench().result().measurements.stretches is None


def _in_two(whole: Segment, at_s: float, step: int, offset_s: float = 0.0) -> Waveforms:
    """A record whose second part keeps every so many-th sample, and may lie off the grid of the first."""
    k = whole.index_at(at_s)
    first = Segment(whole.t0_s, whole.dt_s, {n: x[:k] for n, x in whole.channels.items()})
    rest = {n: x[k::step] for n, x in whole.channels.items()}
    return Waveforms((first, Segment(whole.t0_s + k * whole.dt_s + offset_s, step * whole.dt_s, rest)))


@pytest.mark.parametrize("step", [1, 2, 8])
def test_record_in_two_segments(bench, step):
    """A record that changes its step in the judged part gets the verdicts of the whole one."""
    made = bench(q_sag_kvar=250, dt_s=CONTROL_STEP_S)
    waveforms = _in_two(made.waveforms().segments[0], 0.5, step)
    result = evaluate(made.profile, made.test, waveforms, made.nominal, 500e3)
    for check, whole in zip(result.checks, made.result().checks, strict=True):
        assert (check.check, check.status) == (whole.check, whole.status)
        assert check.margin == pytest.approx(whole.margin, rel=1e-3, abs=1e-3)


def test_record_in_two_segments_on_grids_of_their_own(bench):
    """Where the grids do not fit, what lies across the change is not evaluated; nothing crashes."""
    made = bench(q_sag_kvar=250)
    waveforms = _in_two(made.waveforms().segments[0], 0.5, 8, offset_s=10e-6)
    result = evaluate(made.profile, made.test, waveforms, made.nominal, 500e3)
    assert result.status is Status.NOT_EVALUATED


def test_verdicts_do_not_depend_on_phase_names(bench):
    """Renaming the phases in order moves the phase a verdict names and nothing else."""
    sags = [Sag(depth=0.9, phases=phase) for phase in "abc"]
    results = [bench(asked=sag, q_sag_kvar=150, p_sag_kw=100).result() for sag in sags]
    rows = [[(c.status, pytest.approx(c.margin, abs=1e-3)) for c in result.checks] for result in results]
    assert rows[0] == [(c.status, c.margin) for c in results[1].checks]
    assert rows[0] == [(c.status, c.margin) for c in results[2].checks]


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("dc_ripple.limit_percent", 0.05),
        ("current_limit.tolerance_pu", 0.0),
        ("current_limit.peak_pu", 0.9),
        ("reactive_support.tolerance_pu", 0.001),
        ("ride_through.recovery_time_s", 0.01),
        ("ride_through.recovery_fraction", 1.0),
    ],
)
def test_limits_stand_in_the_profile(bench, tmp_path, key, value):
    """A profile of one's own that changes one number changes that verdict, and no other."""
    kind, number = key.split(".")
    file = tmp_path / "mine.toml"
    file.write_text(
        f'schema_version = 1\nid = "mine"\ntitle = "mine"\ninclude = ["iec61400-21"]\n[requirements.{kind}.{number}]\n'
        f'value = {value}\nconfidence = "chosen"\nsource = "a test"\n'
    )
    faint = {"q_sag_kvar": 248.0, "dc_ripple_percent": 0.1, "p_after_kw": 500.0 if "time" in key else 498.0}
    faint |= {"p_after_kw": 503.0} if "tolerance_pu" in key and kind == "current_limit" else {}
    assert bench(**faint).result().status is Status.PASS
    result = bench(profile=load_profile(str(file)), **faint).result()
    assert [check.check for check in result.checks if check.status is Status.FAIL] == [kind]


def test_confidence_is_the_weakest_that_decided(bench, tmp_path):
    """A verdict carries the weakest mark of the numbers it rests on, not that of its neighbours."""
    file = tmp_path / "mine.toml"
    file.write_text(
        'schema_version = 1\nid = "mine"\ntitle = "mine"\ninclude = ["iec61400-21"]\n'
        '[requirements.dc_ripple]\nlimit_percent = { value = 0.15, confidence = "code", source = "a test" }\n'
    )
    result = bench(profile=load_profile(str(file)), q_sag_kvar=250).result()
    assert {c.check: c.confidence for c in result.checks}["dc_ripple"] == "code"
    assert {c.check: c.confidence for c in result.checks}["current_limit"] == "chosen"


def test_test_that_gave_no_waveforms(bench, iec):
    """A simulation that failed is an error on every requirement, with its reason."""
    result = errored(iec, bench().test, "not finite at 0.31 s")
    assert result.status is Status.ERROR
    assert [check.check for check in result.checks] == KINDS
    assert {check.message for check in result.checks} == {"not finite at 0.31 s"}


def test_summary_says_what_is_not_verified(iec):
    """A report names the profile, its digest and each number that was not verified."""
    summary = summarise(iec, iec.tests())
    assert (summary.id, summary.digest) == (iec.id, iec.digest)
    assert any(note.startswith("ride_through envelope: inferred (NTS 631") for note in summary.notes)
    assert any(note.startswith("tests VD1, VD2") and ": memory (" in note for note in summary.notes)
    assert not any("curve" in note.split(":")[0] for note in summary.notes)


CUSTOM = """
schema_version = 1
id = "with-custom"
title = "a demand of another package"
include = ["iec61400-21"]
[requirements.custom.{kind}]
clause = "7.7"
source = "a test"
numbers.limit_pu = {{ value = 0.4, confidence = "memory", source = "a test" }}
"""


def test_check_from_another_package(bench, tmp_path: Path, monkeypatch):
    """A package adds a kind of requirement by an entry point; its judge gets the profile's numbers and the record."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "lowest_voltage.py").write_text(
        "from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail\n"
        "def judge(requirement, evidence):\n"
        "    limit = requirement.numbers['limit_pu']\n"
        "    low = evidence.measurements.during.voltage_positive_pu\n"
        "    return judged('lowest_voltage', requirement, pass_or_fail(low >= limit.value), 'seen', measured=low,\n"
        "        limit=limit.value, margin=low - limit.value, unit='pu', at_s=0.4, rests_on=[limit])\n"
    )
    info = tmp_path / "lowest_voltage-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lowest-voltage\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[pvlvrt_compliance.checks]\nlowest_voltage = lowest_voltage:judge\n")
    file = tmp_path / "custom.toml"
    file.write_text(CUSTOM.format(kind="lowest_voltage"))
    with pytest.warns(DeprecationWarning, match="make it a class"):
        check = bench(profile=load_profile(str(file)), q_sag_kvar=250).check("lowest_voltage")
    assert (check.status, check.clause, check.confidence) == (Status.PASS, "7.7", "memory")
    assert check.margin == pytest.approx(0.1, abs=1e-6)


def test_no_package_hides_behind_the_name_of_the_built_in_checks(bench, tmp_path: Path, monkeypatch):
    """What another package announces under the name of this one's entry is found all the same."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "next_door.py").write_text(
        "from pvlvrt_compliance.checks.api import Check, CustomRequirement, NotApplicable\n"
        "class Elsewhere(Check):\n"
        "    kind = 'elsewhere'\n"
        "    title = 'Elsewhere'\n"
        "    requirement = CustomRequirement\n"
        "    def judge(self, requirement, evidence):\n"
        "        raise NotApplicable('found')\n"
    )
    info = tmp_path / "next_door-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: next_door\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[pvlvrt_compliance.checks]\nbuilt-in = next_door:Elsewhere\n")
    file = tmp_path / "custom.toml"
    file.write_text(CUSTOM.format(kind="elsewhere"))
    assert bench(profile=load_profile(str(file)), q_sag_kvar=250).check("elsewhere").message == "found"


def test_requirement_that_nothing_judges(bench, tmp_path: Path):
    """A demand without an installed check is not evaluated; it never passes."""
    file = tmp_path / "custom.toml"
    file.write_text(CUSTOM.format(kind="unheard_of"))
    check = bench(profile=load_profile(str(file)), q_sag_kvar=250).check("unheard_of")
    assert check.status is Status.NOT_EVALUATED
    assert "unheard_of" in check.message


def test_every_number_is_finite(bench):
    """No verdict of a dead grid carries a number that is not finite."""
    made = bench(depth=0.999, duration_s=0.2, q_sag_kvar=0.5)
    numbers = [x for c in made.result().checks for x in (c.measured, c.limit, c.margin, c.at_s) if x is not None]
    assert numbers
    assert all(map(math.isfinite, np.asarray(numbers)))


def test_a_record_that_is_judged_is_let_go(bench, monkeypatch):
    """Nothing that was made of it holds it, so that its memory is there for the next one at once."""
    kept = []

    def seen(*arguments):
        made = evidence_of(*arguments)
        kept.append(weakref.ref(made))
        return made

    monkeypatch.setattr("pvlvrt_compliance.checks.evaluate.evidence_of", seen)
    gc.collect()
    gc.disable()
    try:
        bench(q_sag_kvar=250).result()
        assert [made() for made in kept] == [None]
    finally:
        gc.enable()
