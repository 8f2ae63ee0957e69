"""The scenario of a test in whole sentences."""

import re

import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.profile import known_profiles, load_profile
from pvlvrt_compliance.report.document.scenario import scenario_words
from pvlvrt_compliance.report.language import BASE, Texts, catalogue, languages
from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.scenario.scenario import Scenario
from told_scenarios import NORMAL, result


def happens(scenario, language="en"):
    """What happens in a scenario, all but what its times count from."""
    texts = Texts(language)
    return tuple(told for told in scenario_words(result(scenario), texts).happens if told != texts("scenario.times"))


SAGS = {
    "All three phases lose 90 % of their voltage for 0.500 s; 10 % is left.": {"depth": 0.9},
    "Phase c loses 50 % of its voltage for 0.500 s; 50 % is left.": {"depth": 0.5, "phases": "c"},
    "Phases b and c lose 25 % of their voltage for 0.500 s; 75 % is left.": {"depth": 0.25, "phases": "bc"},
    "The voltage between phases c and a loses 40 % for 0.500 s, without zero sequence; 60 % is left.": {
        "depth": 0.4,
        "phases": "ca",
        "two_phase": True,
    },
    "A sag of type D of Bollen's classification, with phase b as its symmetrical phase, loses 30 % for 0.500 s; "
    "70 % is left.": {"depth": 0.3, "phases": "b", "type": "D"},
    "Phase a is turned by +60° for 0.500 s.": {"depth": 0, "phases": "a", "angle_deg": 60},
    "Phases a and b lose 50 % of their voltage and are turned by -12.5° for 0.500 s; 50 % is left.": {
        "depth": 0.5,
        "phases": "ab",
        "angle_deg": -12.5,
    },
}

EVENTS = {
    "At 0.450 s phase a loses 95 % of its voltage for 0.150 s; 5 % is left.": {
        "kind": "sag",
        "t_s": 0.45,
        "duration_s": 0.15,
        "sag": {"depth": 0.95, "phases": "a"},
    },
    "At 0.500 s the voltage is whole for 0.100 s.": {"kind": "sag", "t_s": 0.5, "duration_s": 0.1, "sag": {"depth": 0}},
    "At 2.500 s the angle of all phases jumps back by 20°.": {"kind": "phase_jump", "t_s": 2.5, "angle_deg": -20},
    "At 0.000 s the frequency steps to 50.5 Hz.": {"kind": "frequency_step", "t_s": 0, "to_hz": 50.5},
    "From 1.000 s on the frequency falls at 0.35 Hz/s for 2.000 s.": {
        "kind": "frequency_ramp",
        "t_s": 1,
        "rate_hz_s": -0.35,
        "duration_s": 2,
    },
    "From 0.149 s on the grid has a short-circuit ratio of 3 and X/R of 10.": {
        "kind": "grid_strength",
        "t_s": 0.149,
        "scr": 3,
    },
    "From 0.149 s on the grid is stiff: the source stands at the terminals of the inverter.": {
        "kind": "grid_strength",
        "t_s": 0.149,
        "scr": None,
    },
    "All the time the source has 10 % of harmonic 5, in negative sequence.": {
        "kind": "harmonic",
        "order": 5,
        "amplitude_pu": 0.1,
    },
    "From 0.100 s on the source has 2 % of harmonic 3, in positive sequence, for 0.200 s.": {
        "kind": "harmonic",
        "order": 3,
        "amplitude_pu": 0.02,
        "sequence": "positive",
        "t_s": 0.1,
        "duration_s": 0.2,
    },
    "At 0.000 s the irradiance steps to 800 W/m².": {"kind": "irradiance", "t_s": 0, "to_w_m2": 800},
    "From 0.000 s on the irradiance moves to 800 W/m² within 2.000 s.": {
        "kind": "irradiance",
        "t_s": 0,
        "to_w_m2": 800,
        "ramp_s": 2,
    },
    "At 0.000 s the recorded voltage of a <b>.csv takes the place of the source.": {
        "kind": "recording",
        "file": "a <b>.csv",
        "t_s": 0,
    },
}


@pytest.mark.parametrize(("sentence", "sag"), SAGS.items())
def test_a_sag_is_a_sentence(sentence, sag):
    """What is lost, what is left, where and for how long."""
    assert happens({"sag": sag}) == (sentence,)


@pytest.mark.parametrize(("sentence", "event"), EVENTS.items())
def test_an_event_is_a_sentence(sentence, event):
    """Each kind of event says when, what and how much; times count from the start of the disturbance."""
    words = scenario_words(result_without_grid({"events": [event]}), Texts())
    assert words.happens[:2] == ("The following happens within 0.500 s.", sentence)


@pytest.mark.parametrize(
    ("scenario", "is_said"),
    [
        ({"sag": {"depth": 0.9}}, False),  # it begins the test: its sentence has no instant
        ({"events": [{"kind": "harmonic", "order": 5, "amplitude_pu": 0.1}]}, False),
        ({"events": [{"kind": "frequency_step", "t_s": 2, "to_hz": 51}]}, True),
        ({"events": [{"kind": "voltage_profile", "points": [[0, 1], [1, 0.9]]}]}, True),
    ],
)
def test_what_times_count_from_is_said_where_there_are_some(scenario, is_said):
    """Only then, in the paragraph that has them; where the test starts counts otherwise and stands elsewhere."""
    words = scenario_words(result(scenario), Texts())
    said = "The times in this paragraph count from the start of the disturbance."
    assert (said in words.happens) == is_said
    assert words.conditions[0].startswith("The disturbance starts 0.300 s into the record")
    assert "into the record" not in " ".join(words.happens)


def result_without_grid(scenario):
    """A test whose disturbance is not needed: a recording has none without its file."""
    return result(scenario, disturbance=None)


def test_a_voltage_profile_is_told_step_by_step():
    """Steps and ramps in order; a level that holds is not said again; of very many, one sentence says how far."""
    points = [[0, 1.0], [0, 0.0], [0.15, 0.0], [1.5, 0.85], [1.5, 1.0]]
    assert happens({"events": [{"kind": "voltage_profile", "points": points}]})[1:] == (
        "At 0.000 s the voltage of all phases steps to 0.000 pu.",
        "From 0.150 s to 1.500 s the voltage of all phases moves along a straight line to 0.850 pu.",
        "At 1.500 s the voltage of all phases steps to 1.000 pu.",
    )
    saw = [[k / 10, level] for k in range(20) for level in ((1.0, 0.5) if k % 2 else (0.5, 1.0))]
    assert happens({"events": [{"kind": "voltage_profile", "points": saw}]})[1:] == (
        "From 0.000 s to 1.900 s the voltage of all phases goes through 21 steps and ramps between 0.500 pu and "
        "1.000 pu.",
    )


@pytest.mark.parametrize(
    ("number", "last"),
    [
        (25, "At 2.400 s the angle of all phases jumps ahead by 5°."),
        (26, "1 further event follows; results.json has it."),
        (5000, "4975 further events follow; results.json has them all."),
    ],
)
def test_as_many_events_are_told_as_anybody_reads(number, last):
    """Those that come first; the others are counted. So are the sags that a record was found to hold."""
    events = [{"kind": "phase_jump", "t_s": k / 10, "angle_deg": 5} for k in range(number)]
    told = happens({"events": events, "duration_s": 501.0})
    assert len(told) == 1 + min(number, 26)
    assert told[-1] == last
    sags = [{"kind": "sag", "t_s": k / 10, "duration_s": 0.05, "sag": {"depth": 0.9}} for k in range(min(number, 50))]
    asked = disturbance_asked(Scenario.model_validate({"sag": {"depth": 0}, "duration_s": 6, "events": sags}), NORMAL)
    found = asked.model_copy(update={"origin": "found"})
    words = scenario_words(result(disturbance=found), Texts()).happens
    assert len(words) == 1 + min(number, 26)
    assert ("follow" in words[-1]) == (number > 25)


def test_conditions_are_told():
    """Frequency, grid, transformer, weather, set-point and the length of the record."""
    scenario = {"frequency_hz": 60, "scr": 3, "xr": 5, "vector_group": "Dyn11", "reactive_power_pu": -0.3, "after_s": 2}
    words = scenario_words(result(scenario), Texts()).conditions
    assert words[1] == "The grid runs at 60 Hz before the disturbance."
    assert words[2] == "The grid has a short-circuit ratio of 3 and X/R of 5."
    assert "vector group Dyn11" in words[3]
    assert words[4] == "The array receives 1000 W/m² at a cell temperature of 25 °C."
    assert words[5] == "Outside of the sag the inverter is set to take 0.3 pu of reactive power."
    assert words[6] == "The record goes on for 2.000 s after the disturbance is cleared."


@pytest.mark.parametrize(
    ("fields", "start"),
    [
        ({"expect": None}, "This is a sag of the user's own"),
        ({"expect": "ride_through"}, "The code demands that all of it"),
        ({"expect": "may_trip"}, "The voltage goes beyond the limits"),
        ({"expect": "must_trip", "by_s": 0.16}, "Connection is demanded for as long as"),
    ],
)
def test_what_a_row_demands_is_told(fields, start):
    """All of it, as long as the limits demand, or open in time; K where the test has its own."""
    demanded = scenario_words(result(k_factor=6.0, **fields), Texts()).demanded
    assert demanded[0].startswith(start)
    assert "0.160 s" in demanded[0] or fields["expect"] != "must_trip"
    assert demanded[1] == "In this test K is 6 in place of the profile's."


def test_a_record_from_the_field_is_told_by_what_was_found():
    """Its scenario is a stand-in: nothing of it is said."""
    grid = disturbance_asked(Scenario.model_validate({"sag": {"depth": 0.9}, "duration_s": 0.5}), NORMAL)
    found = grid.model_copy(update={"origin": "found"})
    words = scenario_words(result({"sag": {"depth": 0.9}}, disturbance=found), Texts())
    assert words.happens == (
        "The record was searched for what the grid did: the disturbance begins at 0.300 s and the voltage stands still "
        "from 0.800 s on; these times count from the start of the record.",
        "From 0.300 s to 0.800 s of the record the voltage is low: V+ is 0.100 pu and V- is 0.000 pu.",
    )
    assert words.conditions == ()


def test_results_without_a_scenario_say_nothing_of_it():
    """Those of another program may have none."""
    words = scenario_words(TestResult(id="t", status=Status.PASS), Texts())
    assert (words.happens, words.conditions) == ((), ())


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", known_profiles())
def test_every_shipped_test_has_its_sentences(name, language):
    """In each language each test of each profile is told in sentences that end and have all their values."""
    for case in load_profile(name).tests():
        words = scenario_words(result_without_grid(case.scenario.model_dump()), Texts(language))
        for sentence in (*words.happens, *words.conditions, *words.demanded):
            assert sentence.endswith("."), sentence
            assert not re.search(r"[{}_]", sentence), sentence


def test_every_kind_of_sag_has_a_first_and_a_further_sentence():
    """A kind that can come first can come later, with its instant."""
    keys = catalogue(BASE).keys()
    first = {key.rpartition(".")[2] for key in keys if key.startswith("scenario.sag.")}
    assert {key.rpartition(".")[2] for key in keys if key.startswith("scenario.further.")} == first | {"nothing"}
