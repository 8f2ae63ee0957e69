"""What a loaded profile says: its tests, durations, provenance and digest."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.data.marks import CONFIDENCES, weakest
from pvlvrt_compliance.errors import ProfileError, UsageError
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.scenario.sag import Sag


@pytest.fixture(scope="module")
def iec() -> Profile:
    """The shipped profile with tests."""
    return load_profile("iec61400-21")


@pytest.fixture(scope="module")
def spain() -> Profile:
    """The shipped profile without tests."""
    return load_profile("spain-q-curve")


def test_catalogue(iec):
    """Six drops at two powers, twice each, and the paper's three sags once: 27 runs with ids of their own."""
    ids = [test.id for test in iec.tests()]
    drops = [f"VD{n}-{power}-{run}" for n in range(1, 7) for power in ("full", "partial") for run in (1, 2)]
    assert ids == [*drops, "paper-three-phase-90", "paper-phase-c-90", "paper-phase-c-50"]


VD_TABLE = {"VD1": (0.9, 0, 0.5), "VD2": (0.5, 0, 0.5), "VD3": (0.2, 0, 0.2)}
VD_TABLE |= {"VD4": (0.95, 0.05, 0.5), "VD5": (0.75, 0.25, 0.5), "VD6": (0.6, 0.4, 0.2)}


def test_voltage_drops(iec):
    """The drops have the positive sequence and the duration that the table gives, at both powers and angles."""
    for test in iec.tests()[:24]:
        drop, power, run = test.id.split("-")
        v_positive, v_negative, duration_s = VD_TABLE[drop]
        sequences = test.scenario.sag.sequences_pu()
        assert (abs(sequences.positive), abs(sequences.negative)) == pytest.approx((v_positive, v_negative), abs=1e-9)
        assert abs(sequences.zero) == pytest.approx(0, abs=1e-9)
        assert test.scenario.duration_s == duration_s
        assert test.scenario.irradiance_w_m2 == {"full": 1000, "partial": 200}[power]
        assert test.scenario.point_on_wave_deg == {"1": 0, "2": 90}[run]
        assert (test.scenario.before_s, test.scenario.after_s) == (0.3, 1.1)
        assert test.confidence == "memory"
        assert test.clause


def test_paper_sags_last_as_the_envelope_demands(iec):
    """The paper's sags last as long as the envelope demands of their V+, and say that this is inferred."""
    tests = iec.tests()[24:]
    assert [test.scenario.duration_s for test in tests] == pytest.approx([0.3088, 1.2618, 1.4735], abs=5e-5)
    assert {test.confidence for test in tests} == {"inferred"}


@pytest.mark.parametrize(
    ("sag", "duration_s"),
    [
        (Sag(depth=0.9), 0.3088),
        (Sag(depth=0.9, phases="c"), 1.2618),
        (Sag(depth=0.5, phases="c"), 1.4735),
        (Sag(depth=1), 0.15),
        (Sag(depth=0.15), 0.5),
        (Sag(depth=0.45, phases="a"), 0.5),
        (Sag(depth=0), 0.5),
    ],
)
def test_default_duration(iec, sag, duration_s):
    """A sag lasts to the envelope by default, and half a second where V+ stays at 0.85 or more."""
    assert iec.sag_duration_s(sag) == pytest.approx(duration_s, abs=5e-5)


def test_profile_without_tests_and_envelope(spain):
    """The demands stand on their own: no test to select, half a second for a sag given by the user."""
    assert spain.tests() == ()
    assert spain.envelope is None
    assert spain.sag_duration_s(Sag(depth=0.9)) == 0.5


@pytest.mark.parametrize(
    ("sag", "name"),
    [
        (Sag(depth=0.9), "sag-90pct-abc"),
        (Sag(depth=0.5, phases="bc", two_phase=True), "sag-50pct-bc-two-phase"),
        (Sag(depth=0.57, phases="c"), "sag-57pct-c"),
        (Sag(depth=0), "sag-0pct-abc"),
        (Sag(depth=0.125), "sag-12.5pct-abc"),
    ],
)
def test_test_of_ones_own(iec, sag, name):
    """A test of the user's own is named by its sag, claims no clause, and takes any field of the scenario."""
    test = iec.ad_hoc_test(sag, 0.4, frequency_hz=60.0, irradiance_w_m2=800)
    assert (test.id, test.clause, test.confidence) == (name, "", "")
    assert (test.scenario.duration_s, test.scenario.frequency_hz, test.scenario.irradiance_w_m2) == (0.4, 60, 800)
    assert test.scenario.before_s == 0.3


def test_fields_out_of_range_are_all_named(iec):
    """Wrong scenario fields are a usage error that names each."""
    with pytest.raises(
        UsageError, match=r'cell_temperature_c: .* 90, not 500.*irradiance: unknown key; did you mean "ir'
    ):
        iec.ad_hoc_test(Sag(depth=0.9), cell_temperature_c=500, irradiance=3)


def test_catalogue_at_another_frequency(iec):
    """A scenario field can be replaced in all tests."""
    assert {test.scenario.frequency_hz for test in iec.tests(frequency_hz=60.0)} == {60}


def test_what_is_confirmed(iec):
    """Eq (9), the clip and "at most nominal" are confirmed; the envelope is inferred; the rest is chosen."""
    demands = iec.requirements
    support, limit = demands.reactive_support, demands.current_limit
    assert {support.curve.confidence, support.clip_to_capability.confidence, limit.limit_pu.confidence} == {"confirmed"}
    assert iec.envelope.confidence == "inferred"
    assert {demand.confidence for _, demand in demands.by_kind()} == {"chosen"}
    assert limit.allowed_pu == 1.02


def test_unverified_numbers_are_listed_once(iec):
    """The list has a sentence for each number that was not verified, and none for one that was."""
    notes = iec.unverified()
    assert len(set(notes)) == len(notes)
    names = [note.split(":")[0] for note in notes]
    assert "ride_through envelope" in names
    assert "current_limit tolerance_pu" in names
    assert "tests VD1, VD2, VD3, VD4, VD5, VD6" in names
    assert not {"current_limit limit_pu", "reactive_support curve", "tests paper-phase-c-90"} & set(names)


def test_only_tests_that_run_count_as_unverified(iec):
    """A run without rows of the test table says nothing of the table; a run with one names that row alone."""
    assert not [note for note in iec.unverified({"sag-90pct-abc"}) if note.startswith("tests ")]
    assert [n.split(":")[0] for n in iec.unverified({"VD3-partial-2"}) if n.startswith("tests ")] == ["tests VD3"]


@given(st.lists(st.sampled_from(CONFIDENCES), min_size=1))
def test_weakest_mark(marks):
    """The weakest mark is one of those given, and none given is weaker; chosen is the weakest of all."""
    found = weakest(marks)
    assert found in marks
    assert all(weakest([found, mark]) == found for mark in marks)
    assert weakest([*marks, "chosen"]) == "chosen"


def test_weakest_of_nothing():
    """Without numbers there is no mark."""
    assert weakest([]) == ""


def test_digest_is_of_the_content(tmp_path):
    """Comments, order and layout do not change the digest; any number does."""
    text = 'title = "t"\nid = "x"\nschema_version = 1\ninclude = ["iec61400-21"]\n'
    one, two, three = (tmp_path / f"{n}.toml" for n in "abc")
    one.write_text(text)
    two.write_text("# a comment\n" + "\n".join(reversed(text.splitlines())) + "\n")
    three.write_text(text + "[requirements.current_limit]\npeak_pu.value = 2.1\n")
    digests = [load_profile(str(file)).digest for file in (one, two, three)]
    assert digests[0] == digests[1] != digests[2]
    assert len(digests[0]) == 64
    assert all(math.isfinite(int(digest, 16)) for digest in digests)


def test_frequency_of_a_profile(tmp_path):
    """A profile names its grid's frequency for all of its tests; a row, and then the user, may name another."""
    file = tmp_path / "mine.toml"
    head = 'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["rey-boue-500kva"]\n[procedure]\n'
    file.write_text(head + 'frequency_hz = { value = 60, confidence = "chosen", source = "a test" }\n')
    mine = load_profile(str(file))
    assert mine.ad_hoc_test(Sag(depth=0.9)).scenario.frequency_hz == 60
    assert {test.scenario.frequency_hz for test in mine.tests()} == {50, 60}
    assert {test.scenario.frequency_hz for test in mine.tests(frequency_hz=55.0)} == {55}


STEPS = """schema_version = 1
id = "mine"
title = "t"
include = ["iec61400-21"]
[procedure.steps.swell]
confidence = "chosen"
source = "a test"
[procedure.steps.swell.steps]
A = { voltage_pu = 1.2, duration_s = 0.5 }
[[tests]]
id = "steps"
clause = "c"
steps = { table = "swell", order = "A", phases = "PHASES" }
powers = ["full"]
confidence = "chosen"
source = "a test"
"""


def test_steps_of_some_phases_only_sag(tmp_path):
    """A step above nominal voltage must be of all phases, since sags alone are of some phases."""
    file = tmp_path / "mine.toml"
    file.write_text(STEPS.replace("PHASES", "abc"))
    assert load_profile(str(file)).tests()[-1].scenario.duration_s == 0.5
    file.write_text(STEPS.replace("PHASES", "a"))
    with pytest.raises(ProfileError, match=r"steps\.phases: a step to 1\.2 pu must be of all phases"):
        load_profile(str(file))


def test_thresholds_are_marked_numbers_that_a_profile_may_state(tmp_path):
    """What decides whether something is judged carries a mark and a reason, is told, and can be another."""
    usual = load_profile("iec61400-21").thresholds
    assert all(number.confidence == "chosen" and number.source for _, number in usual)
    file = tmp_path / "mine.toml"
    file.write_text(
        'schema_version = 1\nid = "mine"\ntitle = "mine"\ninclude = ["iec61400-21"]\n[thresholds]\n'
        'normal_low_pu = { value = 0.85, confidence = "confirmed", source = "a text" }\n'
    )
    mine = load_profile(str(file))
    assert mine.thresholds.normal_low_pu.value == 0.85
    assert mine.thresholds.normal_high_pu == usual.normal_high_pu
    assert mine.digest != load_profile("iec61400-21").digest
    assert any(note.startswith("thresholds normal_high_pu: chosen") for note in mine.unverified())
    assert not any(note.startswith("thresholds normal_low_pu") for note in mine.unverified())


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("settled_cycles.value = 1000", "thresholds.settled_cycles: must be at most 20, not 1000"),
        ("voltage_floor_pu.value = 0.5", "thresholds.voltage_floor_pu: must be at most 0.2, not 0.5"),
        (
            "normal_low_pu.value = 1.3",
            "normal_low_pu and normal_high_pu must lie on either side of 1: 1.3, 1.1",
        ),
        ("setled_cycles.value = 2", 'thresholds.setled_cycles: unknown key; did you mean "settled_cycles"'),
    ],
)
def test_thresholds_that_would_leave_nothing_to_judge_are_refused(tmp_path, line, says):
    """No profile can switch its judges off by a floor, nor call a nominal voltage a sag."""
    name = line.partition(".")[0]
    marks = f'{name}.confidence = "chosen"\n{name}.source = "a test"\n'
    file = tmp_path / "mine.toml"
    head = 'schema_version = 1\nid = "mine"\ntitle = "mine"\ninclude = ["iec61400-21"]\n[thresholds]\n'
    file.write_text(head + line + "\n" + marks)
    with pytest.raises(ProfileError) as told:
        load_profile(str(file))
    assert says in str(told.value)
