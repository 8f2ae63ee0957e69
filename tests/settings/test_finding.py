"""Which file of settings is taken."""

import os
from pathlib import Path

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.settings.finding import find_file

TABLE = '[tool.pvlvrt]\nsag = "10%"\n'


def found(folder=None):
    """Path of the file that is taken from a folder on; None where there is none."""
    taken = find_file(folder or Path.cwd()).file
    return None if taken is None else taken.source.path


def test_nearest_upwards(project):
    """Of two files the nearer one is taken, from any folder below."""
    (project / "a" / "b" / "c").mkdir(parents=True)
    (project / "pvlvrt.toml").touch()
    assert found(project / "a" / "b" / "c") == Path("pvlvrt.toml")
    (project / "a" / "b" / "pvlvrt.toml").touch()
    assert found(project / "a" / "b" / "c") == Path("a/b/pvlvrt.toml")
    assert found(project / "a") == Path("pvlvrt.toml")


def test_own_file_before_that_of_the_project(project):
    """In one folder pvlvrt.toml counts; a pyproject.toml nearer by counts before a pvlvrt.toml further up."""
    (project / "pvlvrt.toml").touch()
    (project / "pyproject.toml").write_text(TABLE, "utf-8")
    assert found() == Path("pvlvrt.toml")
    (project / "sub").mkdir()
    (project / "sub" / "pyproject.toml").write_text(TABLE, "utf-8")
    assert found(project / "sub") == Path("sub/pyproject.toml")


@pytest.mark.parametrize(
    "text",
    [
        '[project]\nname = "x"\n',
        '[project]\ndependencies = ["pvlvrt-compliance"]\n',
        "[tool.ruff]\n",
        "not toml at all",
    ],
)
def test_a_project_without_the_table_is_passed_over(project, text):
    """What has no [tool.pvlvrt] is no file of settings, and whatever else is wrong with it is not told."""
    (project / "pvlvrt.toml").touch()
    (project / "sub").mkdir()
    (project / "sub" / "pyproject.toml").write_text(text, "utf-8")
    assert found(project / "sub") == Path("pvlvrt.toml")


def test_a_table_that_is_none(project):
    """A key of the name that holds something else is told with its line."""
    (project / "pyproject.toml").write_text("[tool]\npvlvrt = 5\n", "utf-8")
    with pytest.raises(UsageError, match=r"pyproject.toml:2: tool.pvlvrt: must be a table"):
        found()


def test_not_beyond_the_repository(project):
    """A file above the root of the repository is not looked for, be the root a clone or a worktree of one."""
    (project.parent / "pvlvrt.toml").touch()
    assert found() is None
    assert f"up to {project}, the root of the repository" in find_file(project).why_not
    (project / ".git").rmdir()
    assert found() == Path("../pvlvrt.toml")
    (project / ".git").write_text("gitdir: elsewhere\n")
    assert found() is None


def test_not_beyond_the_home_folder(project, monkeypatch):
    """The home folder is the last that is looked in."""
    (project / ".git").rmdir()
    (project.parent / "pvlvrt.toml").touch()
    monkeypatch.setattr(Path, "home", lambda: project)
    assert found() is None
    assert "the home folder" in find_file(project).why_not
    (project / "pvlvrt.toml").touch()
    assert found() == Path("pvlvrt.toml")


@pytest.fixture
def user(monkeypatch):
    """Be another user: ``user(id)``; root may not be had, but who it is can be said."""
    if not hasattr(os, "getuid"):
        pytest.skip("no owners here")
    return lambda uid: monkeypatch.setattr(os, "getuid", lambda: uid)


def test_not_a_file_of_somebody_else(project, user):
    """Another user's file is not used, nor one beyond it, and that is told; a link to one's own is another's, too."""
    (project / "sub").mkdir()
    (project / "pvlvrt.toml").touch()
    mine = (project / "pvlvrt.toml").stat().st_uid
    (project / "sub" / "pyproject.toml").write_text(TABLE, "utf-8")
    user(mine + 1)
    if mine != 0:
        search = find_file(project / "sub")
        assert search.file is None
        assert "sub/pyproject.toml is not used: it belongs to somebody else" in search.refused
    user(mine)
    assert found(project / "sub") == Path("sub/pyproject.toml")


def test_owners(project, user, monkeypatch):
    """One's own file and root's are used; any other is not, whether the file's or that of the link to it."""
    file = project / "pvlvrt.toml"
    file.touch()
    real = Path.stat
    owners = {"file": 1000, "link": 1000}

    def stat(path, *, follow_symlinks=True):
        status = list(real(path, follow_symlinks=follow_symlinks))
        status[4] = owners["file" if follow_symlinks else "link"]
        return os.stat_result(status)

    monkeypatch.setattr(Path, "stat", stat)
    user(1000)
    for of_file, of_link, used in ((1000, 1000, True), (0, 0, True), (7, 7, False), (1000, 7, False), (7, 1000, False)):
        owners.update(file=of_file, link=of_link)
        search = find_file(project)
        assert (search.file is not None) == used
        assert bool(search.refused) != used


def test_not_a_file_that_anybody_may_write(project):
    """A file of one's own that is open to all is no more trusted than another's."""
    (project / "pvlvrt.toml").touch()
    (project / "pvlvrt.toml").chmod(0o666)
    assert found() is None
    assert find_file(project).refused.startswith("pvlvrt.toml is not used: anybody may write it")
    assert "--config pvlvrt.toml uses it" in find_file(project).refused
    (project / "pvlvrt.toml").chmod(0o664)
    assert found() == Path("pvlvrt.toml")


def test_without_owners(project, monkeypatch):
    """Where a system has no owners, a file is taken as it is."""
    monkeypatch.delattr(os, "getuid", raising=False)
    (project / "pvlvrt.toml").touch()
    assert found() == Path("pvlvrt.toml")
