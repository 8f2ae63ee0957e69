"""What a profile may multiply into is bounded, and all that is wrong is told in our words, with line and key."""

import re
from itertools import pairwise

import pytest

from pvlvrt_compliance.errors import ProfileError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.profile import MOST_TESTS
from pvlvrt_compliance.scenario.events import LONGEST_S

ROW = """
[[tests]]
id = "X"
clause = "c"
{what}
powers = ["full"]
confidence = "chosen"
source = "s"
"""
SAG = "sag = { depth = 0.5 }\nduration_s = 0.5"
STEPS = """
[procedure.steps.t]
confidence = "chosen"
source = "s"
steps = {{ A = {{ voltage_pu = {level}, duration_s = {lasts} }} }}
"""


def problems(path):
    """What a profile is refused for, a line each; empty where it is not."""
    try:
        load_profile(path).tests()
    except ProfileError as error:
        return list(error.problems)
    return []


def with_steps(lasts, order, level=0.5, phases="abc"):
    """A row of steps."""
    steps = f'steps = {{ table = "t", order = "{order}", phases = "{phases}" }}'
    return STEPS.format(lasts=lasts, level=level) + ROW.format(what=steps)


def angles(count):
    """So many points on wave."""
    return f"points_on_wave_deg = [{', '.join(f'{k % 360}.0' for k in range(count))}]"


@pytest.mark.parametrize("more", [0, 1])
def test_powers_by_points_on_wave(write, more):
    """The most tests that a profile may have, and one more: how many there are, which row makes them."""
    others = len(load_profile("iec61400-21").tests())
    found = problems(write(ROW.format(what=f"{SAG}\n{angles(MOST_TESTS - others + more)}")))
    if not more:
        assert found == []
        return
    (said,) = found
    count = f"make {MOST_TESTS + 1} tests, {MOST_TESTS - others + 1} of them here; {MOST_TESTS} are allowed"
    assert said.endswith(f"mine.toml:6: tests[0]: rows x powers x points_on_wave_deg {count}")


def test_points_on_wave_of_all_tests(write):
    """Those of the procedure multiply every row."""
    text = f'[procedure.points_on_wave_deg]\nvalues = {angles(3000)[21:]}\nconfidence = "chosen"\nsource = "s"\n'
    (said,) = problems(write(text))
    assert re.search(r"make \d{5,} tests, \d+ of them here; 5000 are allowed$", said)


def corners(count, ride_s=1.0, inside_s=0.1):
    """Regions side by side, each with a time to stay connected, and tests made of them."""
    edges = [0.9 * k / count for k in range(count + 1)]
    rows = [f'{{ voltage_pu = [{a}, {b}], mode = "mandatory", ride_s = {ride_s} }}' for a, b in pairwise(edges)]
    rows.append('{ voltage_pu = [0.9, 1.1], mode = "continuous" }')
    return f"""
[requirements.ride_through.regions]
confidence = "chosen"
source = "s"
low_quantity = "positive_sequence"
high_quantity = "positive_sequence"
rows = [{", ".join(rows)}]

[procedure.corners]
clause = "c"
confidence = "chosen"
source = "s"
inside_pu = 1e-6
inside_s = {inside_s}
powers = ["full", "partial"]
phases = ["abc", "a", "bc"]
"""


@pytest.mark.parametrize(("regions", "made"), [(3, ""), (3000, "make 20031 tests"), (9000, "make 20031 tests")])
def test_tests_made_of_regions(write, regions, made):
    """Regions by phases by powers; of many no more is made than shows that it is too many."""
    found = problems(write(corners(regions)))
    assert bool(found) == bool(made)
    assert all(made in said and "procedure.corners" in said for said in found)


@pytest.mark.parametrize(
    ("ride_s", "inside_s", "says"),
    [
        (LONGEST_S, 0.1, ""),
        (LONGEST_S + 1, 0.1, "would last 3600.9 s; above 0 s and up to 3600 s are allowed"),
        (1.0, 0.999, ""),
        (1.0, 1.0, "would last 0 s; above 0 s and up to 3600 s are allowed"),
        (1e300, 1.0, "would last 1e+300 s"),
    ],
)
def test_how_long_a_test_of_a_region_lasts(write, ride_s, inside_s, says):
    """A time that no test can last is told at the table that asks for the tests."""
    found = problems(write(corners(2, ride_s, inside_s)))
    assert bool(found) == bool(says)
    assert all(
        "mine.toml:1" in said and "procedure.corners: a test just inside" in said and says in said for said in found
    )


@pytest.mark.parametrize(
    ("lasts", "order", "says"),
    [
        (LONGEST_S, "A", None),
        (4000, "A", "mine.toml:9: procedure.steps.t.steps.A.duration_s: must be less than or equal to 3600, not 4000"),
        (1800, "AA", None),
        (1800.1, "AA", "mine.toml:14: tests[0].steps.order: the steps last 3600.2 s; 3600 s are allowed"),
        (0.1, "A" * 1000, None),
        (0.1, "A" * 1001, "tests[0].steps.order: must have at most 1000 characters, not 'AAA"),
    ],
)
@pytest.mark.parametrize("phases", ["abc", "a"])
def test_how_long_steps_last(write, lasts, order, says, phases):
    """A step or all of them: one problem, at the key that says it."""
    found = problems(write(with_steps(lasts, order, phases=phases)))
    assert len(found) == (says is not None)
    assert all(says in said for said in found)


MISTAKES = {
    "a step of 4000 s": with_steps(4000, "A"),
    "a long date": 'read_on = "2020-13-77"\n',
    "a date": "read_on = 5\n",
    "an id": ROW.format(what=SAG).replace('"X"', '"X/.."'),
    "a whole number": "[requirements.repeated_runs]\nconsecutive = 1.5\n",
    "a word": ROW.format(what=SAG + '\nexpect = "sometimes"'),
    "a text": ROW.format(what=SAG + "\ntitle = 7"),
    "a flag": ROW.format(what=SAG + '\nlong = "yes"'),
    "a list": ROW.format(what=SAG + "\npoints_on_wave_deg = 3"),
    "a number of 5000 digits": ROW.format(what=f"sag = {{ depth = 0.{'9' * 5000} }}\nduration_s = {'9' * 5000}"),
    "a number of 400 digits": ROW.format(what=f"sag = {{ depth = 0.5 }}\nduration_s = {'9' * 400}.0"),
    "an event of 4000 s": ROW.format(what=SAG + '\nevents = [{ kind = "phase_jump", t_s = 4000, angle_deg = 1 }]'),
    "a grid": ROW.format(what=SAG + "\ngrid = { scr = 1e9, xr = 0 }"),
    "an hour": ROW.format(what="sag = { depth = 0.5 }\nduration_s = 3601"),
    "before": ROW.format(what=SAG + "\nbefore_s = 1e300\nafter_s = 1e-300"),
    "frequency": ROW.format(what=SAG + "\nfrequency_hz = 1e-300"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_what_is_wrong_is_told_in_our_words(write, mistake):
    """Each problem is one line with file, line and key, and nothing of the library that finds it."""
    found = problems(write(MISTAKES[mistake]))
    assert found
    for said in found:
        assert re.match(r".*mine\.toml:\d+: [\w.\[\]]+: .", said)
        assert "\n" not in said
        assert not re.search(r"pydantic|Input should|String should|\[type=|validation error", said)
        assert len(said) < 400
