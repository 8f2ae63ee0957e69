"""What packages announce is found as Python finds it, and without reading all of them where there is nothing."""

import subprocess
import sys
import zipfile
from importlib.metadata import DistributionFinder, PathDistribution, entry_points
from pathlib import Path

import pytest

from pvlvrt_compliance.data.announced import announced

GROUP = "a_group.of_a_test"


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Install a package that announces something: ``package(group, folder)``, in a place of the search path."""

    def install(group=GROUP, folder="company-1.0.dist-info", place="place", on_path=True):
        metadata = tmp_path / place / folder
        metadata.mkdir(parents=True)
        name = "METADATA" if folder.endswith("dist-info") else "PKG-INFO"
        (metadata / name).write_text("Metadata-Version: 2.1\nName: company\nVersion: 1.0\n")
        (metadata / "entry_points.txt").write_text(f"[{group}]\nlast = os\nfirst = os.path\n")
        if on_path:
            monkeypatch.syspath_prepend(tmp_path / place)
        return metadata

    return install


def names():
    """What is announced, which is what the standard library finds."""
    found = [entry.name for entry in announced(GROUP)]
    assert found == sorted(entry.name for entry in entry_points(group=GROUP))
    return found


def test_nothing_is_announced(package):
    """Another group is none of this one."""
    package("another_group")
    assert names() == []


@pytest.mark.parametrize(
    ("folder", "place"),
    [
        ("company-1.0.dist-info", "place"),
        ("Company-1.0.DIST-INFO", "place"),
        ("company.egg-info", "place"),
        ("EGG-INFO", "company.egg"),
    ],
)
def test_what_an_installed_package_announces(package, folder, place):
    """In whatever form its metadata lies on the search path; sorted by name."""
    package(folder=folder, place=place)
    assert names() == ["first", "last"]


def test_the_current_folder_is_on_the_search_path(package, monkeypatch):
    """As an empty text."""
    monkeypatch.chdir(package(on_path=False).parent)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    assert names() == ["first", "last"]


def test_a_package_in_an_archive(package, tmp_path, monkeypatch):
    """The standard library reads it."""
    metadata = package(on_path=False)
    with zipfile.ZipFile(tmp_path / "packages.zip", "w") as archive:
        for file in metadata.iterdir():
            archive.write(file, f"{metadata.name}/{file.name}")
    monkeypatch.syspath_prepend(tmp_path / "packages.zip")
    assert names() == ["first", "last"]


def test_a_package_that_is_found_in_another_way(package, monkeypatch):
    """Python may be told to find packages elsewhere than on its search path."""
    metadata = package(on_path=False)

    class Elsewhere(DistributionFinder):
        """Finds the one package."""

        def find_distributions(self, context=None):  # noqa: ARG002 - as the standard library asks
            return [PathDistribution(metadata)]

    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path, Elsewhere()])
    assert names() == ["first", "last"]


def test_places_that_are_not_there_have_nothing(monkeypatch, tmp_path):
    """As Python's own archive of modules mostly is not."""
    monkeypatch.setattr(sys, "path", [str(tmp_path / "none"), str(tmp_path)])
    assert names() == []


def test_nothing_is_loaded_for_nothing():
    """Where no package names the group its metadata is left alone."""
    code = (
        "import sys\nfrom pvlvrt_compliance.data.announced import announced\n"
        f"print(announced({GROUP!r}), 'importlib.metadata' in sys.modules)"
    )
    package = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code], cwd=package, capture_output=True, text=True, check=True)
    assert done.stdout == "[] False\n"
