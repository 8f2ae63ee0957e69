"""Includes without measure: each file is read once, and what they lead to is bounded."""

from pathlib import Path

import pytest

from pvlvrt_compliance.data import merging
from pvlvrt_compliance.data.merging import MOST_FILES, merge_file
from pvlvrt_compliance.errors import ProfileError
from pvlvrt_compliance.profile.profile import SCHEMA_VERSION


@pytest.fixture
def written(tmp_path):
    """Write files of some names, each with the names that it includes; return the path of the first."""

    def write(includes: dict[str, list[str]]) -> Path:
        for name, included in includes.items():
            text = f'schema_version = {SCHEMA_VERSION}\ninclude = {included}\ntitle = "{name}"\n'
            (tmp_path / f"{name}.toml").write_text(text, "utf-8")
        return tmp_path / f"{next(iter(includes))}.toml"

    return write


@pytest.fixture
def read(monkeypatch):
    """Names of the files that are read, in order."""
    names = []

    class Counted(merging.Source):
        def __init__(self, path, *rest):
            names.append(Path(path).stem)
            super().__init__(path, *rest)

    monkeypatch.setattr(merging, "Source", Counted)
    return names


def levels(count, twice=2):
    """Files in levels, each of which includes the next so many times."""
    return {f"f{k}": [f"f{k + 1}"] * (twice if k + 1 < count else 0) for k in range(count)}


def refusal(path):
    """What a profile is refused for; None when it is not."""
    try:
        merge_file(path, SCHEMA_VERSION)
    except ProfileError as error:
        return error.problems
    return None


def test_a_file_that_is_included_in_two_ways_is_read_once(written, read):
    """What two files share stands before either, and is read for both."""
    path = written({"mine": ["left", "right"], "left": ["base"], "right": ["base"], "base": []})
    merged = merge_file(path, SCHEMA_VERSION)
    assert [source.path.stem for source in merged.sources] == ["base", "left", "base", "right", "mine"]
    assert sorted(read) == ["base", "left", "mine", "right"]


def test_includes_that_double_at_each_level(written, read):
    """Six levels are 63 files with their repetitions; forty would be a million million, and each is read but once."""
    assert refusal(written(levels(6))) is None
    assert read == [f"f{k}" for k in range(6)]
    read.clear()
    (problem,) = refusal(written(levels(40)))
    assert f"f33.toml:2: include[1]: 'f34' leads to more than {MOST_FILES} files, each counted as often" in problem
    assert read == [f"f{k}" for k in range(40)]


@pytest.mark.parametrize(
    ("files", "problem"), [(MOST_FILES, None), (MOST_FILES + 1, "include[0]: 'f64' leads to more")]
)
def test_includes_one_after_the_other(written, files, problem):
    """The longest chain that is read, and the shortest that is not."""
    found = refusal(written(levels(files, twice=1)))
    assert found == problem or problem in found[0]


@pytest.mark.parametrize(
    ("files", "problem"), [(MOST_FILES, None), (MOST_FILES + 1, "mine.toml:2: include[63]: 'b63'")]
)
def test_includes_beside_each_other(written, files, problem):
    """The longest list that is read, and the shortest that is not."""
    names = [f"b{k}" for k in range(files - 1)]
    found = refusal(written({"mine": names} | {name: [] for name in names}))
    assert found == problem or problem in found[0]


def test_a_problem_of_a_file_that_is_included_twice_is_told_once(written, tmp_path):
    """The same line of the same file is one problem."""
    path = written({"mine": ["base", "base"]})
    (tmp_path / "base.toml").write_text('title = "base"\n', "utf-8")
    assert len(merge_file(path, SCHEMA_VERSION).problems) == 1
