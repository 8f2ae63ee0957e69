"""The words of a stretch between two steps: of the catalogue, on the clock of the record."""

import re
from itertools import pairwise

import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.profile import known_profiles, load_profile
from pvlvrt_compliance.report.document.stretches import stretch_words
from pvlvrt_compliance.report.language import Texts, languages
from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.scenario.events import Recording
from pvlvrt_compliance.scenario.scenario import Scenario

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
START_S = 0.3  # of a test in its record, unless told otherwise


def told(scenario, language="en", **fields):
    """A sentence or more for each stretch of a scenario, by when it begins (s, of the record)."""
    made = Scenario.model_validate({"sag": {"depth": 0}, "duration_s": 0.5} | scenario)
    grid = disturbance_asked(made, NORMAL).model_copy(update=fields)
    test = TestResult(id="t", status=Status.PASS, scenario=made.model_dump(mode="json"), disturbance=grid)
    begins = [START_S, *(step.at_s for step in grid.steps if step.at_s > START_S), made.end_s]
    return [stretch_words(test, *span, Texts(language)) for span in pairwise(dict.fromkeys(begins))]


def test_a_sag_begins_and_ends():
    """When it begins in the record, how deep; then the voltage is normal again."""
    assert told({"sag": {"depth": 0.8}}) == [
        "At 0.300 s all three phases lose 80 % of their voltage for 0.500 s; 20 % is left.",
        "The voltage is normal.",
    ]
    assert told({"sag": {"depth": 0.8}}, "es") == [
        "A los 0.300 s las tres fases pierden el 80 % de su tensión durante 0.500 s; queda el 20 %.",
        "La tensión es normal.",
    ]


def test_instants_are_those_of_the_record():
    """A step 8 s after the start of the test is 8.300 s into the record, as the heading of its stretch says."""
    steps = [{"kind": "frequency_step", "t_s": t, "to_hz": hz} for t, hz in ((0, 51), (8, 50))]
    assert told({"duration_s": 10, "events": steps}) == [
        "At 0.300 s the frequency steps to 51 Hz.",
        "At 8.300 s the frequency steps to 50 Hz.",
    ]


def test_what_holds_on_is_told_beside_what_begins():
    """A jump of the angle within a sag: the sag began before, so what is left of the voltage is told."""
    jump = {"kind": "phase_jump", "t_s": 0.2, "angle_deg": 20}
    assert told({"sag": {"depth": 0.9, "phases": "c"}, "events": [jump]})[1] == (
        "At 0.500 s the angle of all phases jumps ahead by 20°. "
        "The voltage is low: V+ is 0.700 pu and V- is 0.300 pu."  # Fortescue: 1 - 0.9 / 3, 0.9 / 3
    )


def test_a_voltage_profile_is_told_stretch_by_stretch():
    """Each stretch has the step or the ramp that begins with it; where the voltage then holds, what it is."""
    points = [[0, 1.0], [0, 0.0], [0.15, 0.0], [0.5, 0.7], [0.8, 0.7], [0.8, 1.0]]
    assert told({"duration_s": 0.8, "events": [{"kind": "voltage_profile", "points": points}]}) == [
        "At 0.300 s the voltage of all phases steps to 0.000 pu.",
        "From 0.450 s to 0.800 s the voltage of all phases moves along a straight line to 0.700 pu.",
        "The voltage is low: V+ is 0.700 pu and V- is 0.000 pu.",
        "At 1.100 s the voltage of all phases steps to 1.000 pu.",
    ]


def test_after_a_ramp_of_the_frequency_it_is_told():
    """51 Hz after a second at 1 Hz/s."""
    ramp = {"kind": "frequency_ramp", "t_s": 0, "rate_hz_s": 1, "duration_s": 1}
    assert told({"duration_s": 2, "events": [ramp]}) == [
        "From 0.300 s on the frequency rises at 1 Hz/s for 1.000 s.",
        "The voltage is normal. The frequency is 51 Hz.",
    ]


def test_a_record_from_the_field_is_told_by_what_was_found():
    """Its scenario is a stand-in: nothing of it is said."""
    sag, after = told({"sag": {"depth": 0.6}}, origin="found")
    assert sag == "The voltage is low: V+ is 0.400 pu and V- is 0.000 pu."
    assert after == "The voltage is normal."


def test_without_a_disturbance_nothing_is_said():
    """Results of an earlier version have none."""
    assert stretch_words(TestResult(id="t", status=Status.PASS), 0, 1, Texts()) == ""


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", known_profiles())
def test_every_stretch_of_every_shipped_test_is_told(name, language):
    """In sentences that end and have all their values."""
    for case in load_profile(name).tests():
        if any(isinstance(event, Recording) for event in case.scenario.events):
            continue  # its disturbance needs the file
        grid = disturbance_asked(case.scenario, NORMAL)
        test = TestResult(id="t", status=Status.PASS, scenario=case.scenario.model_dump(mode="json"), disturbance=grid)
        for part in grid.following_stretches(case.scenario.end_s):
            words = stretch_words(test, part.begin_s, part.end_s, Texts(language))
            assert words.endswith("."), case.id
            assert not re.search(r"[{}_]", words), words
