"""Variants of a profile: tests overridden, added and dropped; where the files of a profile are found."""

import importlib.metadata
import os
import sys
import types

import pytest

from pvlvrt_compliance.data.search_path import ENTRY_POINT_GROUP, find_profile
from pvlvrt_compliance.errors import ProfileError, UsageError
from pvlvrt_compliance.profile import known_profiles, load_profile

MARK = 'confidence = "chosen"\nsource = "a test"\n'
ROW = '[[tests]]\nid = "{}"\nclause = "c"\nduration_s = 0.5\npowers = ["full"]\nsag = {{ depth = 0.5 }}\n' + MARK


def ids(profile):
    """Ids of the rows of a test table."""
    return [row.id for row in profile.rows]


def test_a_row_overrides_the_included_row_of_its_id(write):
    """Only the keys given change; the row keeps its place."""
    shipped, mine = load_profile("iec61400-21"), load_profile(write('[[tests]]\nid = "VD2"\nsag.phases = "a"\n'))
    assert ids(mine) == ids(shipped)
    assert mine.rows[1].sag.phases == "a"
    assert mine.rows[1].sag.depth == 0.5
    assert mine.rows[1].clause == shipped.rows[1].clause
    assert mine.rows[:1] + mine.rows[2:] == shipped.rows[:1] + shipped.rows[2:]


def test_other_rows_follow(write):
    """A row of a new id comes after the included ones."""
    assert ids(load_profile(write(ROW.format("new")))) == [*ids(load_profile("iec61400-21")), "new"]


def test_rows_are_dropped_by_patterns(write):
    """Shell patterns on ids; what the file adds itself stays, even under an id that it has dropped."""
    path = write(ROW.format("VD1"), include='["iec61400-21"]\ndrop_tests = ["VD*", "paper-phase-c-[59]0"]')
    assert ids(load_profile(path)) == ["paper-three-phase-90", "VD1"]


def test_drops_hold_for_those_who_include(write):
    """A variant of a variant has what the variant left."""
    write(name="base", include='["iec61400-21"]\ndrop_tests = ["VD*"]')
    assert ids(load_profile(write(include='["base"]'))) == ids(load_profile("iec61400-21"))[6:]


@pytest.mark.parametrize(
    ("drop", "problem"),
    [
        ('["VD1", "U5*"]', ":5: drop_tests[1]: 'U5*' drops no test that is included"),
        ('"VD1"', ":5: drop_tests: must be a list of patterns"),
        ("[1]", ":5: drop_tests: must be a list of patterns"),
    ],
)
def test_wrong_drops(write, drop, problem):
    """A pattern that drops nothing is a mistake, as a misspelt one would go unnoticed."""
    path = write(include=f'["iec61400-21"]\ndrop_tests = {drop}')
    with pytest.raises(ProfileError, match="1 problem") as caught:
        load_profile(path)
    assert caught.value.problems[0].startswith(path + problem)


def test_a_problem_of_an_overridden_row_stands_where_it_was_written(write):
    """Of a row that two files write, each key is told at its file and line."""
    base = write(ROW.format("T").replace("0.5", "-0.5", 1), name="base")
    mine = write('[[tests]]\nid = "T"\n\nsag.depth = 2\n', include='["base"]')
    with pytest.raises(ProfileError) as caught:
        load_profile(mine)
    assert [problem.partition(" must")[0] for problem in caught.value.problems] == [
        f"{mine}:8: tests[0].sag.depth:",
        f"{base}:8: tests[0].duration_s:",
    ]


def test_an_id_overrides_once(write):
    """Two rows of one id in one file are a mistake although an included file has the id, too."""
    path = write(
        '[[tests]]\nid = "VD1"\nduration_s = 1\n' + ROW.format("VD1").replace('["full"]', '["full", "partial"]')
    )
    with pytest.raises(ProfileError, match=r"tests\[1\]\.id: the id 'VD1-full-1' occurs twice"):
        load_profile(path)


def test_a_folder_of_the_users_comes_first(write, tmp_path, monkeypatch):
    """A name is looked for in $PVLVRT_PROFILES before the shipped profiles; a path is a path."""
    (tmp_path / "codes").mkdir()
    write(name="codes/spain-q-curve", include='["mine"]')
    mine = write()
    shipped = find_profile("spain-q-curve")
    monkeypatch.setenv("PVLVRT_PROFILES", os.pathsep.join([str(tmp_path), str(tmp_path / "codes")]))
    assert load_profile("mine").id == "mine"
    assert known_profiles()["mine"] == (tmp_path / "mine.toml", str(tmp_path))
    assert find_profile("spain-q-curve") == tmp_path / "codes" / "spain-q-curve.toml"
    assert known_profiles()["spain-q-curve"].origin == str(tmp_path / "codes")
    assert known_profiles()["iec61400-21"].origin == "shipped"
    assert load_profile(str(shipped)).id == "spain-q-curve"
    assert load_profile(mine).id == "mine"


def test_a_folder_that_is_not_there_is_named_with_its_variable(tmp_path, monkeypatch):
    """A misspelt folder is an error, not an empty one."""
    monkeypatch.setenv("PVLVRT_PROFILES", str(tmp_path / "nowhere"))
    with pytest.raises(UsageError, match=r"\$PVLVRT_PROFILES: there is no folder .*nowhere"):
        load_profile("iec61400-21")


@pytest.fixture
def entry_point(monkeypatch):
    """Announce folders of profiles as a package does: ``entry_point(what the entry point refers to)``."""

    def announce(announced):
        module = types.ModuleType("a_company_codes")
        module.announced = announced
        monkeypatch.setitem(sys.modules, module.__name__, module)
        entry = importlib.metadata.EntryPoint("company", f"{module.__name__}:announced", ENTRY_POINT_GROUP)
        monkeypatch.setattr(
            "pvlvrt_compliance.data.search_path.announced", lambda group: [entry] * (group == ENTRY_POINT_GROUP)
        )

    return announce


def a_module(file):
    """A module as if imported from a file."""
    module = types.ModuleType("codes")
    module.__file__ = file
    return module


@pytest.mark.parametrize(
    "form", [lambda p: a_module(str(p / "__init__.py")), lambda p: lambda: p], ids=["module", "function"]
)
def test_packages_bring_profiles(write, tmp_path, entry_point, form):
    """An entry point is a module beside the files or a function that returns their folder."""
    write(name="company")
    write(name="spain-q-curve")
    entry_point(form(tmp_path))
    assert load_profile("company").id == "company"
    assert known_profiles()["company"].origin == "entry point company"
    assert known_profiles()["spain-q-curve"].origin == "shipped"


def test_an_installed_package_brings_profiles(write, tmp_path, monkeypatch):
    """A package with the metadata of an installation is found by its entry point and named as the origin."""
    folder, metadata = tmp_path / "company_codes", tmp_path / "company_grid_codes-1.0.dist-info"
    folder.mkdir()
    metadata.mkdir()
    (folder / "__init__.py").write_text("")
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: company-grid-codes\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[{ENTRY_POINT_GROUP}]\ncompany = company_codes\n")
    write(name="company_codes/plant")
    monkeypatch.syspath_prepend(tmp_path)
    assert known_profiles()["plant"] == (folder / "plant.toml", "package company-grid-codes")


@pytest.mark.parametrize("announced", [lambda: "nowhere", lambda: 1 / 0, None], ids=["no folder", "error", "nothing"])
def test_an_entry_point_that_is_broken_is_named(entry_point, announced):
    """Shipped profiles load in spite of it; an unknown name meets it."""
    entry_point(announced)
    assert load_profile("spain-q-curve")
    with pytest.raises(UsageError, match=r"profiles of entry point 'company' \(a_company_codes:announced\)"):
        load_profile("other")
