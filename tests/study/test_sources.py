"""What the package consists of: every file counts where it decides something."""

import shutil
from pathlib import Path

import pytest

import pvlvrt_compliance
from pvlvrt_compliance.study import sources


@pytest.fixture
def copied(tmp_path, monkeypatch):
    """A copy of the package and of its templates, which is looked at instead."""
    package, reports = tmp_path / "package", tmp_path / "reports"
    shutil.copytree(Path(pvlvrt_compliance.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(sources.resource_folder("reports"), reports)
    monkeypatch.setattr(pvlvrt_compliance, "__file__", str(package / "__init__.py"))
    monkeypatch.setattr(sources, "resource_folder", lambda _: reports)
    return tmp_path


@pytest.mark.parametrize(
    ("file", "of_a_record"),
    [
        ("package/sogi.py", True),
        ("package/controllers/fmu/door.py", True),
        ("package/checks/evaluate.py", False),
        ("package/report/page/section.py", False),
        ("reports/judged.html.j2", False),
        ("reports/texts/es.toml", False),
    ],
)
def test_an_edited_file_is_another(copied, file, of_a_record):
    """A record goes by what simulates it; a result by what judges and tells it besides, on whatever machine."""
    before = sources.of_records(), sources.of_results()
    with (copied / file).open("a", encoding="utf-8") as text:
        text.write("\n")
    after = sources.of_records(), sources.of_results()
    assert (before[0] != after[0], before[1] != after[1]) == (of_a_record, True)
    assert set(sources.of_records()) < set(sources.of_results())
