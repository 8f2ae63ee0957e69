"""However a run is made, its folder is the same."""

import pytest

from pvlvrt_compliance.study.executors import choosing

RUN = ("--profile", "iec61400-21", "--test", "VD[46]-full-*", "--csv", "--format", "markdown", "-q")


@pytest.mark.slow
def test_every_byte_is_that_of_one_core(command, tmp_path, monkeypatch):
    """Two processes write what one core writes, and say the same."""
    monkeypatch.setattr(choosing, "PAYS_FROM_S", 0.0)
    found = []
    for jobs in ("1", "2"):
        (folder := tmp_path / jobs).mkdir()
        monkeypatch.chdir(folder)
        ended = command(*RUN, "--jobs", jobs, SOURCE_DATE_EPOCH="1700000000")
        files = {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        found.append((ended.status, ended.out, files))
    assert found[0] == found[1]
    assert len(found[0][2]) > 4
