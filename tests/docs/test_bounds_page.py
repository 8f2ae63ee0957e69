"""The page of bounds has the numbers of the program, and its table of what needs what is whole."""

import re

from pvlvrt_compliance.data.merging import MOST_FILES
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.data.syntax import DEEPEST
from pvlvrt_compliance.data.text import LARGEST_FILE_MIB
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.profile import MOST_TESTS
from pvlvrt_compliance.scenario.events import LONGEST_S, MOST_INSTANTS, MOST_PROFILES, SHORTEST_S
from pvlvrt_compliance.simulation.parameters import LONGEST, LONGEST_PERIOD_S, SHORTEST_PERIOD_S, parameter_names
from pvlvrt_compliance.simulation.thinning import MOST_BYTES
from pvlvrt_compliance.study.cost import MOST_STEPS
from pvlvrt_compliance.study.idle import NEEDS, OF_TESTS, OF_THE_RUN
from validation.places import DOCS

TEXT = (DOCS / "bounds.md").read_text("utf-8")
BOUNDS, NEEDED = TEXT.split("## What needs what")


def test_each_bound_is_that_of_the_program():
    """In the second column of its row."""
    cells = [row.split(" | ")[1] for row in BOUNDS.splitlines() if row.startswith("| ")][1:]
    program = [
        f"{LARGEST_FILE_MIB} MiB",
        f"{DEEPEST} levels",
        "64 bits",
        f"{MOST_FILES}",
        f"{MOST_TESTS}",
        "1000",
        f"{1e6 * SHORTEST_S:g} µs to {LONGEST_S:g} s",
        f"{MOST_INSTANTS}",
        f"{MOST_PROFILES}",
        "30 Hz, from 40 to 70 Hz",
        f"{LONGEST} characters",
        "its range, ",
        f"{1e6 * SHORTEST_PERIOD_S:g} µs to {LONGEST_PERIOD_S:g} s",
        "above 0.5 up to 100000; 0.01 to 1000",
        f"{MOST_BYTES >> 30} GiB",
        f"{MOST_STEPS}",
    ]
    assert len(cells) == len(program)
    assert all(cell.startswith(said) for cell, said in zip(cells, program, strict=True))


def test_what_needs_what_is_whole():
    """Each parameter and option of the tables of the program, and no other."""
    named = [name for row in NEEDED.splitlines() if row.startswith("| `") for name in _code(row.split(" | ")[0])]
    assert {name for name in named if not name.startswith("--")} == set(NEEDS)
    options = {name.removeprefix("--").replace("-", "_") for name in named if name.startswith("--")}
    assert options == {*OF_TESTS, *OF_THE_RUN}
    assert set(NEEDS) <= set(parameter_names())


def _code(text):
    return re.findall(r"`([^`]+)`", text)


def test_what_ships_is_far_inside():
    """Fifty times the tests of any profile are allowed, and three times as long an order of steps."""
    profiles = [load_profile(name) for name in known_profiles()]
    assert 50 * max(len(profile.tests()) for profile in profiles) <= MOST_TESTS
    assert max(len(row.steps.order) for profile in profiles for row in profile.all_rows if row.steps) < 1000 / 3
