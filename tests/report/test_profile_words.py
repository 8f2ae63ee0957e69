"""A profile in words, whole or at the width of a terminal."""

import re

import pytest

from pvlvrt_compliance.profile import known_profiles, load_profile
from pvlvrt_compliance.report.profile_words import render


@pytest.mark.parametrize("columns", [40, 80, 200])
@pytest.mark.parametrize("name", list(known_profiles()))
def test_a_profile_at_a_terminal_is_broken_between_words(name, columns):
    """No line is wider than the terminal but by one word, and no word is lost or out of its place."""
    profile = load_profile(name)
    whole, broken = render(profile), render(profile, columns)
    for line in broken.splitlines():
        assert len(line) <= columns or len(line.split()) == 1
    parts = [text.partition("\nTESTS: ") for text in (whole, broken)]
    assert parts[0][0].split() == parts[1][0].split()
    for row in profile.all_rows:
        told = " ".join(parts[1][2].split())
        assert row.id in told
        assert row.clause in told
        assert row.title in told


def test_a_time_that_grows_with_the_voltage_is_told_in_words():
    """Its value where it begins and how it goes on, each with its unit; names of keys are no words."""
    text = " ".join(render(load_profile("ieee1547-cat-ii")).split())
    assert "mode mandatory, ride 3 s at 0.65 pu, and +8.7 s/pu from there " in text


@pytest.mark.parametrize("name", list(known_profiles()))
def test_no_unit_stands_in_place_of_a_name(name):
    """Every quantity has a name: a key that is only a unit (`s`) would be told as "s 3 s"."""
    assert re.findall(r"(?<![\w.])(?:s|pu|hz|deg) -?\d[\d.]* ?(?:s|pu|Hz|deg)?\b", _of_rows(load_profile(name))) == []


def _of_rows(profile):
    """What a profile says of its numbers, up to its tests, without sources."""
    lines = render(profile).partition("\nTESTS: ")[0].splitlines()
    return "\n".join(line.partition(" [")[0] for line in lines if " source: " not in line)
