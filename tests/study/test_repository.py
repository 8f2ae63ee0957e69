"""Where what was run lies in its repository."""

import pytest

from pvlvrt_compliance.study.repository import files_of, places_in_repository, repository_of


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository with a controller in a folder, seen from that folder."""
    (tmp_path / "root" / ".git").mkdir(parents=True)
    (tmp_path / "root" / "src").mkdir()
    (tmp_path / "root" / "src" / "ctrl.py").touch()
    (tmp_path / "outside.py").touch()
    monkeypatch.chdir(tmp_path / "root" / "src")
    return tmp_path / "root"


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("ctrl.py", "src/ctrl.py"),
        ("ctrl.py:Control", "src/ctrl.py"),
        ("../src/ctrl.py", "src/ctrl.py"),
        ("../../outside.py", None),
        ("missing.py:Control", None),
        ("tcp://127.0.0.1:5000", None),
        ("x" * 5000, None),
        ("a\0b", None),
        ("", None),
    ],
)
@pytest.mark.usefixtures("repository")
def test_places_count_from_the_root(name, place):
    """A file within the repository by its path from there; whatever else was named has no place."""
    assert places_in_repository({"controller": name}) == ({"controller": place} if place else {})


@pytest.mark.usefixtures("repository")
def test_files_of_a_run():
    """The controller's, and those of profiles by their id; a controller that is a class has none."""
    assert files_of("ctrl.py:Control", {"my-code": "ctrl.py", "other": "../../outside.py"}) == {
        "controller": "src/ctrl.py",
        "profiles": {"my-code": "src/ctrl.py"},
    }
    assert files_of(object, {}) == files_of(None, {}) == {}


def test_the_nearest_repository_counts(repository):
    """A submodule, whose `.git` is a file, is one of its own."""
    inner = repository / "inner"
    (inner / "deep").mkdir(parents=True)
    (inner / ".git").write_text("gitdir: elsewhere")
    assert repository_of(inner / "deep") == inner
    assert repository_of(repository / "src") == repository
