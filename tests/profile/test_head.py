"""The head of a profile: which text it is made from, and what of that text it does not judge."""

import datetime
import json

import pytest

from pvlvrt_compliance.data.merging import OWN
from pvlvrt_compliance.errors import ProfileError
from pvlvrt_compliance.profile import known_profiles, load_profile

OF_BASE = """
edition = "1st"
jurisdiction = "Atlantis"
applies_to = { plant = "all", power = "1 MW", voltage = "20 kV" }
address = "https://example.org/code"
read_on = "2026-01-31"
not_covered = [
    { what = "flicker", clause = "9.1", why = "no scenario has it" },
    { what = "earthing", why = "not electrical" },
]
"""


def whats(profile):
    """What a profile says that it does not judge."""
    return [entry.what for entry in profile.not_covered]


def test_a_head_is_read(write):
    """Every key comes back as the file has it; a date may also be one of TOML."""
    profile = load_profile(write(OF_BASE, include='["es-po-12.3"]\ndrop_not_covered = ["*"]'))
    assert (profile.edition, profile.jurisdiction, profile.address) == ("1st", "Atlantis", "https://example.org/code")
    assert profile.applies_to.model_dump() == {"plant": "all", "power": "1 MW", "voltage": "20 kV"}
    assert profile.read_on == datetime.date(2026, 1, 31)
    assert whats(profile) == ["flicker", "earthing"]
    assert load_profile(write("read_on = 2026-01-31\n")).read_on == profile.read_on


def test_the_head_of_an_include_does_not_count(write):
    """A file that builds on another is of another text: it says itself which, or leaves it open."""
    write(OF_BASE, name="base", include='["es-po-12.3"]')
    profile = load_profile(write('edition = "2nd"\n', include='["base"]'))
    assert profile.edition == "2nd"
    told = json.loads(profile.model_dump_json(exclude_defaults=True))
    assert OWN & told.keys() == {"edition"}
    nothing = load_profile("spain-q-curve").model_copy(update={"applies_to": profile.applies_to})
    assert OWN.isdisjoint(json.loads(nothing.model_dump_json(exclude_defaults=True)))


def test_what_an_include_leaves_out_stays_left_out(write):
    """Entries join by what they are of; the including file's entry wins, key by key."""
    write(OF_BASE, name="base", include='["es-po-12.3"]\ndrop_not_covered = ["*"]')
    mine = 'not_covered = [{ what = "earthing", clause = "7" }, { what = "noise", why = "no sensor" }]\n'
    profile = load_profile(write(mine, include='["base"]'))
    assert whats(profile) == ["flicker", "earthing", "noise"]
    assert (profile.not_covered[1].clause, profile.not_covered[1].why) == ("7", "not electrical")


def test_what_is_judged_after_all_is_dropped(write):
    """Shell patterns drop entries of includes; one that drops nothing is a mistake with its line."""
    write(OF_BASE, name="base", include='["es-po-12.3"]')
    assert whats(load_profile(write(include='["base"]\ndrop_not_covered = ["fli*", "power factor*", "a total*"]'))) == [
        "earthing"
    ]
    with pytest.raises(ProfileError) as error:
        load_profile(write(include='["base"]\ndrop_not_covered = ["nothing"]'))
    assert ":5: drop_not_covered[0]: 'nothing' drops no entry that is included" in str(error.value)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("editoin = '1st'", 'editoin: unknown key; did you mean "edition"?'),
        ("address = 'library'", "address: "),
        ("read_on = 'yesterday'", "read_on: "),
        ("applies_to = { plants = 'all' }", 'applies_to.plants: unknown key; did you mean "plant"?'),
        ("not_covered = 'much'", "not_covered: must be a list of tables, [[not_covered]], not 'much'"),
        ("not_covered = [{ what = 'flicker' }]", "not_covered[0].why: missing"),
        ("not_covered = [{ why = 'no scenario' }]", "not_covered[0].what: missing"),
    ],
)
def test_a_wrong_head_is_told(write, text, problem):
    """What is wrong is told with its line and key, also in a list that goes on from an include's."""
    with pytest.raises(ProfileError) as error:
        load_profile(write(f"{text}\n", include='["es-po-12.3"]'))
    assert f":5: {problem}" in str(error.value)


@pytest.mark.parametrize("name", known_profiles())
def test_shipped_profiles_have_heads(name):
    """Every shipped profile says which plants it is for; one that is of a code says its edition; dates are past."""
    profile = load_profile(name)
    assert profile.applies_to.plant
    assert profile.edition or name in {"spain-q-curve", "rey-boue-500kva"}, "only the paper's own have no edition"
    assert profile.read_on is None or profile.read_on < datetime.date(2027, 1, 1)
    assert len(set(whats(profile))) == len(whats(profile))
