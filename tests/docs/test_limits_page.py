"""The page of limits says what the code has: every limit, by its parameter, with its default."""

import re

import pytest

from pvlvrt_compliance.controllers.limits import OPENING, TABLE, TIME, in_words, limits_of_opening, limits_of_run
from pvlvrt_compliance.simulation.parameters import SimulationParameters, parameter_names
from validation.places import DOCS

PAGE = (DOCS / "controllers" / "limits.md").read_text("utf-8")
ROWS = dict(re.findall(r"^\| [a-z ]+ \| `(simulation\.\w+)` \| ([^|]+) \|", PAGE, re.MULTILINE))


def test_every_limit_is_there_in_order():
    """The time to open a controller, then those of a run; each can be set."""
    assert list(ROWS) == [OPENING.parameter, *(limit.parameter for limit in TABLE.values())]
    assert set(ROWS) <= set(parameter_names())


@pytest.mark.parametrize("parameter", [name for name in ROWS if name != TABLE[TIME].parameter])
def test_defaults_are_those_of_the_code(parameter):
    """The number in the table is that of a run without `--set`."""
    default = SimulationParameters.model_fields[parameter.partition(".")[2]].default
    assert float(ROWS[parameter].split()[0]) == default
    endings = {"_s": "s", "_mb": "MB"}
    unit = next((unit for end, unit in endings.items() if parameter.endswith(end)), "")
    assert ROWS[parameter] == f"{default:g} {unit}".strip()


def test_the_time_of_a_run_grows_with_its_record():
    """By what the table says for each second."""
    first, each = map(float, re.findall(r"(\d+) s", ROWS[TABLE[TIME].parameter]))
    for record_s in (0.0, 1.5, 1800.0):
        assert limits_of_run(SimulationParameters(), record_s).time_s == first + each * record_s
    assert limits_of_run(SimulationParameters(time_limit_s=7.0), 1.5).time_s == 7.0


def test_each_parameter_reaches_its_limit():
    """What is set is what holds, in a run and when a controller is opened, and is in the words for it."""
    for number, name in enumerate(TABLE, start=3):
        key = TABLE[name].parameter.partition(".")[2]
        simulation = SimulationParameters.model_validate({key: number})
        found = in_words(name, limits_of_run(simulation, 1.0))
        assert f" {number} " in found
        assert f"({TABLE[name].parameter})" in found
        if name != TIME:
            assert getattr(limits_of_opening(simulation), name) == number
    opening = limits_of_opening(SimulationParameters(opening_limit_s=9.0))
    assert opening.time_s == 9.0
    assert f"({OPENING.parameter})" in in_words(TIME, opening)


def test_the_page_tells_what_is_fixed():
    """Numbers that cannot be set are those of the code, too."""
    from pvlvrt_compliance.controllers.process import answer, isolation
    from pvlvrt_compliance.controllers.program import door
    from pvlvrt_compliance.controllers.python import door as python

    assert f"{door._STARTING_S:g} s until a program is ready, and {door._REPLY_S:g} s for each answer" in PAGE
    assert f"{answer._LONGEST_TEXT} characters of a message" in PAGE
    assert f"{python._MOST_SIGNALS} signals of a Python class" in PAGE
    assert f"{answer._MOST_CHANNELS:,} channels".replace(",", " ") in PAGE
    assert f"the last {isolation._SAID_CHARACTERS} characters are shown" in PAGE
