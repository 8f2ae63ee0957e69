"""The pages on profiles and checks: each has one, and what they name is there."""

import re
from functools import cache

import pytest

from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.requirements import BUILT_IN
from validation.mutations.mutants import MUTANTS
from validation.reference import __main__ as command
from validation.reference import checks, profiles

SECTIONS = ["How it is measured", "Limit, tolerance, uncertainty", "What it does not see", "Facts"]
_IN_CODE = re.compile(r"`([a-z][a-z0-9]*(?:_[a-z0-9]+)+)`")

# What a page may name besides keys of its requirement and kinds.
OTHER_NAMES = {
    "frequency_accuracy_hz",  # a threshold of every profile
    "respond_s",  # a key of a region
    "not_applicable",
    "not_evaluated",
    "may_trip",
    "must_trip",
    "at_least",
    "at_most",
}


@cache
def shipped():
    """All profiles that ship."""
    return [load_profile(name) for name in profiles.shipped()]


def test_every_check_has_a_page_and_every_page_a_check():
    """A check without one would be known to its source alone."""
    assert sorted(checks.pages().values()) == sorted(set(checks.FOLDER.glob("*.md")) - {checks.FOLDER / "index.md"})


def test_every_shipped_profile_has_a_page():
    """And no other page lies beside them."""
    assert sorted(file.stem for file in profiles.FOLDER.glob("*.md")) == sorted([*profiles.shipped(), "index"])


def test_the_pages_say_what_the_data_say():
    """`python -m validation.reference` would change nothing, and no figure is left over."""
    assert command.work(check=True).problems == []


@pytest.mark.parametrize("kind", BUILT_IN)
def test_a_page_of_a_check_is_whole(kind):
    """Title, what is asked, how it is measured with a link, limits, what is not seen, and the facts."""
    text = checks.pages()[kind].read_text("utf-8")
    assert text.startswith(f"# {find_check(kind).title}\n\n")
    assert re.findall(r"^## (.*)$", text, re.MULTILINE) == SECTIONS
    assert "](../measurements.md#" in text.partition("## Limit, tolerance")[0]
    blind = text.partition("## What it does not see")[2].partition("## Facts")[0]
    assert blind.count("\n- ") >= 3


@pytest.mark.parametrize("kind", BUILT_IN)
def test_what_a_page_names_is_there(kind):
    """Names in code type are keys of the check's requirement, kinds, keys of conditions, or words of a verdict."""
    written = checks.pages()[kind].read_text("utf-8").partition("<!-- facts -->")[0]
    known = {*find_check(kind).requirement.model_fields, *BUILT_IN, *OTHER_NAMES}
    assert set(_IN_CODE.findall(written)) <= known


@pytest.mark.parametrize("kind", BUILT_IN)
def test_the_facts_of_a_check_are_those_of_the_profiles(kind):
    """Each profile with the requirement is there with its clause, and no other; so is each wrong controller."""
    facts = checks.pages()[kind].read_text("utf-8").partition("<!-- facts -->")[2]
    linked = set(re.findall(r"\]\(\.\./profiles/([\w.-]+)\.md\)", facts))
    having = {profile.id: profile.requirements.of_kind(kind) for profile in shipped()}
    assert linked == {name for name, requirement in having.items() if requirement is not None}
    assert all(having[name].clause in facts.replace("&lt;", "<") for name in linked)
    failing = [mutant.name for mutant in MUTANTS if kind in mutant.fails]
    assert failing, "a check that no wrong controller fails shows nothing"
    assert all(f"- {name}\n" in facts for name in failing)


def test_a_page_of_a_profile_has_its_numbers_clauses_and_gaps():
    """Read against the profile: every number of a requirement, every clause, every row, and what is left out."""
    for profile in shipped():
        text = (profiles.FOLDER / f"{profile.id}.md").read_text("utf-8").replace("&lt;", "<")
        for kind, requirement in profile.requirements.by_kind():
            assert f"../checks/{kind}.md" in text
            assert requirement.clause in text
        assert all(f"| `{row.id}` |" in text for row in profile.all_rows)
        assert all(f"| {entry.what} |" in text for entry in profile.not_covered)
    nts = (profiles.FOLDER / "es-nts-631-lt110kv.md").read_text("utf-8")
    assert "| `k` | 3.5 | confirmed |" in nts
    assert "| `envelope` | (0, 0.05), (0.2, 0.05), (1.5, 0.85) | *inferred* |" in nts
    assert "frequency 47.5 to 49 Hz, ride 1800 s" in nts


def test_a_page_that_is_behind_is_found(monkeypatch, tmp_path):
    """A number that has changed makes its page stale, and no other."""
    for file in profiles.FOLDER.glob("*"):
        text = file.read_text("utf-8")
        (tmp_path / file.name).write_text(text.replace("| `k` | 3.5 |", "| `k` | 2.5 |"), "utf-8")
    monkeypatch.setattr(profiles, "FOLDER", tmp_path)
    problems = command.work(check=True).problems
    assert problems == ["stale: es-nts-631-ge110kv.md", "stale: es-nts-631-lt110kv.md"]
