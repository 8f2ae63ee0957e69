"""What somebody asks for becomes tests and parameters, or a message that names what he has typed."""

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.study.job import Asked, Job, make_job

IEC = "iec61400-21"


def job(spell=str, **asked) -> Job:
    """Job of the profile, unless others are asked for."""
    return make_job(Asked(**({"profiles": (IEC,)} | asked)), spell)


def option(name):
    """How the command spells a field."""
    return f"--{name.replace('_', '-')}"


@pytest.mark.parametrize(
    ("asked", "field", "says"),
    [
        ({"profiles": ()}, "profiles", "profiles is missing; known profiles: "),
        ({"sag": "2"}, "sag", "sag: '2' is outside 0% to 100%"),
        ({"sag": 0.5, "phases": "x"}, "phases", "phases x: unknown; allowed are abc, a, b, c, ab, bc, ca"),
        ({"sag": 0.5, "two_phase": True, "phases": "a"}, "two_phase", "two_phase: a pair of phases is needed"),
        ({"sag": 0.5, "sag_type": "Q"}, "sag_type", "sag_type Q: allowed are A, B, C, D, E, F, G"),
        ({"sag": 0.5, "duration": "5"}, "duration", "duration: '5' is not a duration; write 500ms or 0.5s"),
        ({"sag": 0.5, "duration": -1.0}, "duration", "duration: '-1.0s' must be longer than zero"),
        ({"sag": 0.5, "irradiance": 1e4}, "irradiance", "irradiance: must be less than or equal to 1500"),
        ({"sag": 0.5, "point_on_wave": 400.0}, "point_on_wave", "point_on_wave: must be less than"),
        ({"frequency": 70.0}, "frequency", "frequency: must be less than or equal to 66"),
        ({"frequency": "70Hz"}, "frequency", "frequency: must be less than or equal to 66"),
        ({"frequency": "50V"}, "frequency", "frequency: '50V' is not a frequency, for its unit 'V' is none of Hz, kHz"),
        ({"frequency": float("nan")}, "frequency", "frequency: nan is not a number that can be used"),
        ({"temperature": 1e3}, "temperature", "temperature: must be"),
        ({"scr": 0.1}, "scr", "scr: must be greater than 0.5"),
        (
            {"transformer": "Q"},
            "transformer",
            "transformer: 'Q' is no vector group; it is D, Y or YN of the sag's side",
        ),
        ({"settings": ("plant.x=1",)}, "settings", "settings plant.x: unknown parameter"),
        ({"fidelity": "best"}, "fidelity", "fidelity: "),
        ({"tests": ("VD9*",)}, "tests", "tests VD9*: no test of this name"),
        ({"waveforms": "few"}, "waveforms", "waveforms few: allowed are all, failed, none"),
        ({"mapping": "x.toml"}, "mapping", "mapping is for the ports of a controller of your own; it needs controller"),
        ({"sag": 0.5, "tests": ("VD1*",)}, "tests", "tests selects from the profile's own tests; it does not go"),
        ({"phases": "a"}, "sag", "phases, two_phase, sag_type, duration, point_on_wave and irradiance need sag"),
    ],
)
def test_a_message_names_what_was_typed(asked, field, says):
    """In Python the keyword, at the command line the option."""
    with pytest.raises(UsageError) as in_python:
        job(**asked)
    assert str(in_python.value).startswith(says)
    with pytest.raises(UsageError) as at_the_command_line:
        job(option, **asked)
    assert option(field) in str(at_the_command_line.value)


@pytest.mark.parametrize("field", ["phases", "sag_type", "duration", "point_on_wave", "irradiance"])
@pytest.mark.parametrize("value", [0.0, "", "x"])
def test_what_describes_a_sag_needs_one(field, value):
    """Whatever is said of a sag that is not asked for is refused, a zero and an empty word, too."""
    with pytest.raises(UsageError, match="need sag"):
        job(**{field: value})


def test_a_number_is_what_its_text_is():
    """0.9 is 90 %, and 0.25 a quarter of a second."""
    of_numbers, of_texts = job(sag=0.9, duration=0.25), job(sag="90%", duration="250ms")
    assert of_numbers.tests == of_texts.tests
    (item,) = of_numbers.tests
    assert (item.test.scenario.sag.depth, item.test.scenario.duration_s) == (0.9, 0.25)


def test_a_value_with_its_unit_is_its_number():
    """A text in the unit of its field, or in another one, asks for what the number alone asks for."""
    of_texts = job(
        sag=0.9, frequency="60Hz", temperature="45C", irradiance="0.5kW/m2", point_on_wave="90 deg", scr="3", xr="4.5"
    )
    of_numbers = job(sag=0.9, frequency=60, temperature=45, irradiance=500, point_on_wave=90, scr=3, xr=4.5)
    assert of_texts.tests == of_numbers.tests


def test_a_loaded_profile_is_as_good_as_its_name():
    """Names and profiles go together; one that comes twice is taken once."""
    profile = load_profile(IEC)
    found = job(profiles=(profile, "es-po-12.3", profile))
    assert [p.id for p in found.profiles] == [IEC, "es-po-12.3"]
    assert found.profiles[0] is profile
    assert {item.profile.id for item in found.tests} == {IEC, "es-po-12.3"}


def test_two_profiles_of_one_id():
    """A report could not tell them apart, wherever they come from."""
    changed = load_profile(IEC).model_copy(update={"title": "another"})
    with pytest.raises(UsageError, match=f"profiles: two profiles have the id '{IEC}'"):
        job(profiles=(IEC, changed))


def test_all_profiles():
    """All that ship, in the place of a name."""
    assert len(job(profiles=("all",), sag=0.5).profiles) == 12


def test_one_sag_for_all_profiles():
    """It is as long as the most demanding of them asks for, and the same scenario for each."""
    alone = [job(profiles=(name,), sag=0.5).tests[0].test.scenario for name in (IEC, "es-po-12.3")]
    together = job(profiles=(IEC, "es-po-12.3"), sag=0.5).tests
    assert {item.test.scenario for item in together} == {together[0].test.scenario}
    assert together[0].test.scenario.duration_s == max(scenario.duration_s for scenario in alone)


def test_long_tests_are_left_out():
    """They are named as left out, unless they are asked for, by name or at all."""
    without = job(profiles=("nerc-prc-029",))
    names = [item.test.id for item in without.left_out]
    assert len(names) == 2
    assert not job(profiles=("nerc-prc-029",), include_long=True).left_out
    assert [item.test.id for item in job(profiles=("nerc-prc-029",), tests=names).tests] == names


def test_no_tests_but_long_ones():
    """That is an error, which says how to have them run."""
    names = [item.test.id for item in job(profiles=("nerc-prc-029",)).left_out]
    with pytest.raises(UsageError, match="all 2 tests selected are long ones; they run with include_long"):
        job(profiles=("nerc-prc-029",), tests=[f"{name[:-1]}?" for name in names])


def test_a_profile_without_tests():
    """A sag of one's own can be judged by it."""
    with pytest.raises(UsageError, match="spain-q-curve: the profile has no tests of its own; give one"):
        job(profiles=("spain-q-curve",))
    assert len(job(profiles=("spain-q-curve",), sag=0.5).tests) == 1


def test_parameters_of_a_controller_of_ones_own():
    """They are kept apart; the bundled controller's are what they are without."""
    settings = ("controller.gain=2", "plant.filter_inductance_h=2e-4")
    found = job(controller="mine.py:Mine", settings=settings)
    assert found.given == {"gain": 2}
    assert found.parameters.plant.filter_inductance_h == 2e-4


def test_the_bundled_controller_by_its_name():
    """Asked for by its name it is the bundled one as without, with its parameters."""
    made = job(profiles=["iec61400-21"], controller="bundled", settings=["controller.reactive_plateau_pu=0"])
    assert made.controller is None
    assert made.parameters.controller.reactive_plateau_pu == 0
    with pytest.raises(UsageError, match="mapping is for the ports of a controller of your own"):
        job(profiles=["iec61400-21"], controller="bundled", mapping="m.toml")


def test_a_class_has_no_mapping():
    """It takes its measurements by their names."""
    with pytest.raises(UsageError, match="mapping: a Python class takes its measurements by their names"):
        job(controller=object, mapping="x.toml")


def test_events_as_a_file_or_as_they_are(tmp_path):
    """Events that are read from a file and those that are given make the same tests."""
    file = tmp_path / "events.toml"
    file.write_text('[[events]]\nkind = "phase_jump"\nt_s = 0.1\nangle_deg = 20\n')
    of_file = job(sag=0.5, events=str(file))
    assert of_file.tests == job(sag=0.5, events=of_file.tests[0].test.scenario.events).tests
    assert of_file.tests != job(sag=0.5).tests
