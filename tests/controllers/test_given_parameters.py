"""Parameters that a user gives: the same mistakes through every kind of door are told in the same words."""

import math
import sys
from pathlib import Path

import fmpy
import pytest
from fmu_sources import description, packed

from pvlvrt_compliance.controllers.description import ParameterInfo
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.doors import door_to
from pvlvrt_compliance.controllers.given_parameters import beyond_their_ranges, checked_parameters, seconds
from pvlvrt_compliance.units import Nominal

FOLDER = Path(__file__).parent
KINDS = ("python", "library", "fmi2", "fmi3", "program")
UNKNOWN = "the controller has no such parameter; did you mean"
MISTAKES = (
    ("gain", "much", "'much' is not a number"),
    ("gain", True, "true is not a number"),
    ("gain", math.inf, "inf is not a finite number"),
    ("gain", 10**400, f"{10**19}... (401 characters) is not a finite number"),
    ("gain", 2.5, "2.5 is out of range; 0 to 2 is allowed"),
    ("gain", -1, "-1 is out of range; 0 to 2 is allowed"),
    ("status", 1.5, "1.5 is not a whole number"),
    ("status", "x", "'x' is not a whole number"),
    ("status", False, "false is not a whole number"),
    ("status", 7, "7 is out of range; 0 to 6 is allowed"),
    ("status", 2**32, "4294967296 is out of range; 0 to 6 is allowed"),
    ("softly", 1, "1 is not true or false"),
    ("softly", "yes", "'yes' is not true or false"),
    ("word", "a\0b", "'a\\x00b' is not a text of whole characters without NUL"),
    ("word", "\udcff", "'\\udcff' is not a text of whole characters without NUL"),
    ("gian", 1.0, f'{UNKNOWN} "gain"?; it has '),
    ("computation_delay_sample", 1, f'{UNKNOWN} "computation_delay_samples"?; it has '),
)
MEANT = tuple(
    (name, value, "")
    for name, value in (("gain", 1), ("gain", 2), ("status", 6.0), ("softly", True), ("word", 5), ("word", "0"))
)
WORDS = {
    2: """<ScalarVariable name="word" valueReference="102" causality="parameter" variability="fixed">
<String start="slow"/></ScalarVariable>
""",
    3: """<String name="word" valueReference="102" causality="parameter" variability="fixed">
<Start value="slow"/></String>
""",
}
KNOWN = (
    ParameterInfo("gain", 1.0, "pu", minimum=0.0, maximum=2.0),
    ParameterInfo("status", 0, minimum=0),
    ParameterInfo("softly", False),
    ParameterInfo("word", "slow"),
)


def fmu(folder, version):
    """FMU with the parameters, whose binary is an empty file."""
    text = description(version).replace("</ModelVariables>", f"{WORDS[version]}</ModelVariables>")
    binary = folder / f"small{fmpy.sharedLibraryExtension}"
    binary.touch()
    return packed(folder, text, binary, fmpy.platform_tuple if version == 3 else fmpy.platform)


def in_kinds(cases):
    """Cases for every kind of controller that has such a thing: a class has no ranges, a library no switches."""
    return [
        (kind, name, value, words)
        for kind in KINDS
        for name, value, words in cases
        if not (kind == "python" and "out of range" in words) and not (kind == "library" and name == "softly")
    ]


@pytest.fixture
def door(compiled, tmp_path, monkeypatch):
    """Open a controller of a kind with parameters: ``door(kind, {name: value})``."""
    opened = []
    monkeypatch.setattr(sys, "path", [*sys.path])  # a controller in Python puts its folder there

    def spec(kind):
        if kind == "python":
            return f"{FOLDER / 'parameterised.py'}:Parameterised"
        if kind == "library":
            return str(compiled("parameterised.c"))
        if kind == "program":
            return f'stdio:"{sys.executable}" "{FOLDER / "parameterised.py"}"'
        return str(fmu(tmp_path, int(kind[-1])))

    def door(kind, given, **allowing):
        opened.append(door_to(spec(kind), given, **allowing))
        return opened[-1]

    yield door
    for each in opened:
        each.close()


@pytest.mark.parametrize(("kind", "name", "value", "words"), in_kinds(MISTAKES))
def test_a_mistake_is_told_in_the_same_words_by_every_door(door, kind, name, value, words):
    """Name, type and range are checked before anything runs; the message names the option and what is allowed."""
    with pytest.raises(DoorError) as error:
        door(kind, {name: value})
    told = f"--set controller.{name}: {words}"
    assert str(error.value).startswith(told) if words.endswith("has ") else str(error.value) == told


@pytest.mark.parametrize(("kind", "name", "value", "_words"), in_kinds(MEANT))
def test_what_is_meant_is_taken_by_every_door(door, kind, name, value, _words):
    """Whole numbers for numbers, numbers without a fraction for whole ones, and anything for a text."""
    assert name in {p.name for p in door(kind, {name: value}).describe().parameters}


@pytest.mark.parametrize("kind", KINDS)
def test_all_mistakes_are_told_at_once(door, kind):
    """A line each, with all names that there are."""
    with pytest.raises(DoorError) as error:
        door(kind, {"gain": "x", "status": 0.5, "gian": 1})
    first, second, third = str(error.value).splitlines()
    assert first == "--set controller.gain: 'x' is not a number"
    assert second == "--set controller.status: 0.5 is not a whole number"
    assert {"gain", "status", "word"} <= set(third.rpartition("it has ")[2].split(", "))


@pytest.mark.parametrize(("kind", "own"), [("fmi2", "sample_time_s"), ("program", "reply_timeout_s")])
def test_parameters_of_the_host_are_known(door, kind, own):
    """What the host takes besides is checked, is meant by a near miss and stands in the list."""
    door(kind, {own: 1})
    for value in (0, -1.0, True, "x", math.nan, 10**400):
        with pytest.raises(DoorError, match=rf"--set controller\.{own}: .* is not a number of seconds above zero"):
            door(kind, {own: value})
    with pytest.raises(DoorError, match=f'did you mean "{own}"\\?; it has gain.*, {own}'):
        door(kind, {own.removesuffix("_s"): 1})


def test_values_take_the_type_of_the_default():
    """A value is of the type of its parameter; a text is as it is written after --set."""
    given = {"gain": 1, "status": 1e3, "softly": True, "word": True}
    found = checked_parameters(given, KNOWN)
    assert found == {"gain": 1.0, "status": 1000, "softly": True, "word": "true"}
    assert [type(value) for value in found.values()] == [float, int, bool, str]
    assert checked_parameters({"word": 1.0}, KNOWN) == {"word": "1.0"}


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"gain": 2.5}, "2.5 pu is out of range; 0 to 2 is allowed"),
        ({"status": -1}, "-1 is out of range; 0 to 127 is allowed"),
        ({"status": 128}, "128 is out of range; 0 to 127 is allowed"),
    ],
)
def test_a_range_is_the_narrower_of_two(given, words):
    """What the controller says and what the type of the parameter holds are both kept."""
    with pytest.raises(DoorError, match=words):
        checked_parameters(given, KNOWN, holds={"status": (-128, 127)})


@pytest.mark.parametrize(("minimum", "maximum", "words"), [(0.5, None, "0.5 and more"), (None, -1.0, "-1 and less")])
def test_half_a_range(minimum, maximum, words):
    """A range may be open."""
    with pytest.raises(DoorError, match=f"is out of range; {words} is allowed"):
        checked_parameters({"x": 0.0}, [ParameterInfo("x", 1.0, minimum=minimum, maximum=maximum)])


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "python"])
def test_a_range_is_left_aside_where_that_is_allowed(door, kind):
    """Of the controller's own ranges none holds then; types, names and what a type holds still do."""
    given = {"gain": -1, "status": 7}
    described = door(kind, given, allow_out_of_range=True).describe()
    assert beyond_their_ranges(given, described.parameters) == {"gain": "-1 (0 to 2)", "status": "7 (0 to 6)"}
    for mistaken, name, value, words in in_kinds(MISTAKES):
        if mistaken == kind and "out of range" not in words:
            with pytest.raises(DoorError) as error:
                door(kind, {name: value}, allow_out_of_range=True)
            assert str(error.value).startswith(f"--set controller.{name}: {words}")
    if kind != "program":  # which has numbers of one type alone
        with pytest.raises(DoorError, match=f"{2**32} is out of range; -2147483648 to 2147483647 is allowed"):
            door(kind, {"status": 2**32}, allow_out_of_range=True)


def test_what_is_beyond_its_range_is_named():
    """With its unit and the range, open or not; a character counts by its code, and what is not given does not."""
    known = [*KNOWN, ParameterInfo("letter", 65, maximum=64), ParameterInfo("H", 1.0, "s", minimum=0.1)]
    given = {"gain": 2.0000001, "letter": "A", "H": 0, "softly": True, "word": "9", "reply_timeout_s": 1e9}
    assert beyond_their_ranges(given, known) == {
        "gain": "2.0000001 pu (0 to 2)",
        "letter": "65 (64 and less)",
        "H": "0 s (0.1 and more)",
    }
    assert beyond_their_ranges({"gain": 2, "status": 0}, known) == {}
    assert checked_parameters({"gain": -5.0}, KNOWN, allow_out_of_range=True) == {"gain": -5.0}


def test_what_is_allowed_reaches_the_controller(door):
    """The value itself, not the nearest within the range."""
    opened = door("library", {"gain": -3.5, "tenth": 0}, allow_out_of_range=True)
    opened.open(Nominal())
    found = opened._open_instance().parameters()
    assert (found["gain"], found["tenth"]) == (-3.5, 0.0)


def test_a_type_of_numbers_is_a_range(door):
    """A number of 32 bits takes what its author wrote as its bounds, though it cannot hold them exactly."""
    for value in (0.1, 0.7):
        door("library", {"tenth": value})
    with pytest.raises(DoorError, match=r"0\.0999 is out of range; 0\.1 to 0\.7 is allowed"):
        door("library", {"tenth": 0.0999})


@pytest.mark.parametrize(
    ("version", "kind", "limits"),
    [
        (2, "Integer", (-(2**31), 2**31 - 1)),
        (3, "Int8", (-128, 127)),
        (3, "UInt16", (0, 65535)),
        (3, "Int64", (-(2**63), 2**63 - 1)),
        (3, "UInt64", (0, 2**64 - 1)),
    ],
)
def test_a_whole_number_of_an_fmu_stays_within_its_type(tmp_path, version, kind, limits):
    """Without a range the type's own holds: nothing is cut to its lowest bits."""
    text = description(version).replace(' min="0" max="6"', "").replace("<Int32 ", f"<{kind} ")
    binary = tmp_path / f"small{fmpy.sharedLibraryExtension}"
    binary.touch()
    file = str(packed(tmp_path, text, binary, fmpy.platform_tuple if version == 3 else fmpy.platform))
    for value in limits:
        door_to(file, {"status": value})
    for value in (limits[0] - 1, limits[1] + 1):
        with pytest.raises(DoorError, match=f"{value} is out of range; {limits[0]} to {limits[1]} is allowed"):
            door_to(file, {"status": value})


def test_seconds_that_are_not_given():
    """Nothing is given, nothing is checked."""
    assert seconds({"gain": 1.0}, "reply_timeout_s") is None


def test_a_default_may_be_a_number_of_another_library():
    """A default that is of a subclass of a type, as numpy's are, is of that type."""
    import numpy as np

    assert checked_parameters({"x": 2}, [ParameterInfo("x", np.float64(1.0))]) == {"x": 2.0}
