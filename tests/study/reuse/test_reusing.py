"""Runs that take their records from a folder."""

import json
import os
import re
from pathlib import Path

import pytest

from pvlvrt_compliance import check
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import StoredRecordWarning, UsageError
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.simulation import simulate as simulation
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.reuse.opening import DEFAULT_SIZE, reuse_notes, simulator_for
from pvlvrt_compliance.study.reuse.store import ENDING

IEC, TEST = "iec61400-21", "VD3-full-1"
CLASS = """
class Mine:
    sample_time_s = 1e-4

    def reset(self, nominal):
        pass

    def step(self, y):
        return y.m_a, y.m_b, y.m_c
"""
REUSE_IN_THE_REPORT = re.compile(
    r"</dl>\s*<h3>Reused records</h3>\s*<dl.*?>(\s*<div>.*?</div>){3}\s*(?=</dl>)", re.DOTALL
)
PROFILE = """
schema_version = 1
id = "mine"
title = "With a current limit of its own"
include = ["iec61400-21"]

[requirements.current_limit]
limit_pu = {value = %s, confidence = "chosen", source = "this test"}
"""


def test_a_changed_number_of_a_profile_is_judged_without_a_simulation(runs, tmp_path):
    """The verdict is that of the new number, on the same record."""
    (tmp_path / "mine.toml").write_text(PROFILE % 1.02)
    asked = {"profiles": tmp_path / "mine.toml", "tests": TEST, "reuse": tmp_path / "records"}
    first = check(**asked)
    assert (len(runs), verdict_of(first).status) == (1, Status.PASS)
    (tmp_path / "mine.toml").write_text(PROFILE % 0.9)
    second = check(**asked)
    assert (len(runs), verdict_of(second).status) == (1, Status.FAIL)
    assert verdict_of(second).limit - verdict_of(first).limit == pytest.approx(0.9 - 1.02, abs=1e-12)
    assert verdict_of(second).measured == verdict_of(first).measured
    assert second.provenance["reuse"] == {"folder": str(tmp_path / "records"), "tests": 1, "reused": 1}


def verdict_of(results):
    """The verdict on the current limit, of the one test."""
    (test,) = results.tests
    return next(verdict for verdict in test.checks if verdict.check == "current_limit")


def test_the_same_bytes_with_and_without(runs, tmp_path, monkeypatch):
    """Records, verdicts, figures: all files, but for what says how the run was made."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    asked = {"profiles": IEC, "tests": TEST, "settings": {"simulation.record_settling": True}}
    found = []
    for name, reuse in (("without", None), ("stored", tmp_path / "r"), ("reused", tmp_path / "r")):
        results = check(**asked, output=tmp_path / name, reuse=reuse)
        found.append((results.run_id, files_in(tmp_path / name)))
    assert len(runs) == 2
    assert found[0] == found[1] == found[2]
    assert len(found[0][1]) == 5  # three reports, and a record of two files


def files_in(folder):
    """Contents of all files, without what says how the run was made."""
    files = {file.relative_to(folder).as_posix(): file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    results = json.loads(files.pop("results.json"))
    results["provenance"] = {k: x for k, x in results["provenance"].items() if k not in ("command", "reuse")}
    for name in ("report.html", "junit.xml"):
        lines = REUSE_IN_THE_REPORT.sub("", files[name].decode()).splitlines()
        files[name] = [line for line in lines if "command" not in line]
    return files | {"results.json": json.dumps(results)}


def test_a_damaged_record_is_simulated_anew(runs, tmp_path):
    """The results are the same; that is said."""
    asked = {"profiles": IEC, "tests": TEST, "reuse": tmp_path}
    first = check(**asked)
    (file,) = tmp_path.glob(f"*{ENDING}")
    file.write_bytes(file.read_bytes()[:-5] + b"wrong")
    with pytest.warns(StoredRecordWarning, match="damaged"):
        again = check(**asked)
    assert (len(runs), again.run_id) == (2, first.run_id)
    assert check(**asked).provenance["reuse"]["reused"] == 1


def test_it_is_off_unless_it_is_asked_for():
    """Nothing is stored, and the results do not speak of it."""
    job = make_job(Asked(profiles=(IEC,)))
    assert (job.reuse, simulator_for(job, None), list(reuse_notes(job, None))) == (None, simulation.simulate, [])


def refused(**asked):
    """What is said of a job that cannot be."""
    with pytest.raises(UsageError) as found:
        make_job(Asked(profiles=(IEC,), **asked), lambda name: f"--{name.replace('_', '-')}")
    return str(found.value)


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no owners on this system")
def test_a_folder_of_somebody_else_is_refused(tmp_path, monkeypatch):
    """Verdicts would rest on what he has put there."""
    if not (owner := tmp_path.stat().st_uid):
        os.chown(tmp_path, 4242, -1)  # root's own would be trusted
        owner = 4242
    monkeypatch.setattr(os, "getuid", lambda: owner + 1)
    assert "it is not used: it belongs to somebody else" in refused(reuse=str(tmp_path))


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no modes on this system")
def test_a_folder_that_anybody_may_write_is_refused(tmp_path):
    """The message names the option, the folder and what to do."""
    (tmp_path / "records").mkdir()
    (tmp_path / "records").chmod(0o777)
    said = refused(reuse=str(tmp_path / "records"))
    assert said.startswith(f"--reuse {tmp_path / 'records'}: it is not used: anybody may write it")
    assert "name a folder of your own" in said


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no modes on this system")
def test_a_folder_is_looked_at_again_where_it_is_used(tmp_path):
    """It may have changed since, or be another one on another machine."""
    job = make_job(Asked(profiles=(IEC,), reuse=str(tmp_path / "records")))
    list(reuse_notes(job, None))
    (tmp_path / "records").chmod(0o777)
    with pytest.raises(UsageError, match="records: it is not used: anybody may write it"):
        simulator_for(job, None)


def test_what_is_no_folder_and_no_size_is_refused(tmp_path):
    """Before anything is run, in words."""
    (tmp_path / "file").write_text("")
    assert refused(reuse=str(tmp_path / "file")) == f"--reuse {tmp_path / 'file'}: it is not a folder"
    assert refused(reuse="") == "--reuse : a folder is needed"
    assert refused(reuse_size="2GB") == "--reuse-size needs --reuse"
    assert refused(reuse="r", reuse_size="2 apples").startswith("--reuse-size: '2 apples' is not a size")
    assert refused(reuse="r", reuse_size="0GB") == "--reuse-size: 0GB must be above zero and at most 1e+06 GB"


@pytest.mark.parametrize(
    ("size", "limit"), [("2GB", 2 * 10**9), ("500MB", 5 * 10**8), (1.5, 1.5 * 10**9), ("1GiB", 2**30), (None, 10**10)]
)
def test_sizes(size, limit):
    """With a unit, or in GB; ten unless it is given."""
    assert make_job(Asked(profiles=(IEC,), reuse="r", reuse_size=size)).reuse_bytes == limit
    assert DEFAULT_SIZE == "10GB"


def test_a_folder_that_cannot_be_made_is_refused(tmp_path):
    """Before the first test."""
    (tmp_path / "file").write_text("")
    job = make_job(Asked(profiles=(IEC,), reuse=str(tmp_path / "file" / "records")))
    with pytest.raises(UsageError, match=r"records: records cannot be kept: Not a directory"):
        list(reuse_notes(job, None))


def test_the_folder_is_the_users_own(tmp_path):
    """Nobody else may look into it, whatever files may be otherwise."""
    job = make_job(Asked(profiles=(IEC,), reuse=str(tmp_path / "a" / "records")))
    assert list(reuse_notes(job, None)) == []
    if os.name == "posix":
        assert (tmp_path / "a" / "records").stat().st_mode & 0o077 == 0


@pytest.fixture
def in_python(tmp_path):
    """A controller that is a Python class, and the job of a run that reuses records."""
    (tmp_path / "mine.py").write_text(CLASS)
    spec = f"{tmp_path / 'mine.py'}:Mine"
    job = make_job(Asked(profiles=(IEC,), tests=(TEST,), controller=spec, reuse=str(tmp_path / "r")))
    return spec, job


def test_a_controller_that_may_read_anything_is_simulated_and_said(in_python):
    """The reason, and what to do."""
    spec, job = in_python
    controller = ForeignSimulator(spec)
    (note,) = reuse_notes(job, controller)
    assert note.startswith(f"{spec}: no records are reused: a Python class may import and read anything")
    assert 'list all files that it is made of and reads in its mapping, files = ["' in note
    assert simulator_for(job, controller) is controller


def test_a_controller_whose_mapping_lists_its_files_is_reused(in_python, monkeypatch):
    """Edited, a file that it lists has it run anew; the record is what the controller gives."""
    spec, job = in_python
    folder = Path(job.reuse).parent
    (folder / "mine.mapping.toml").write_text('files = ["gains.csv"]\n')
    (folder / "gains.csv").write_text("1")
    calls, right = [], ForeignSimulator.__call__
    monkeypatch.setattr(ForeignSimulator, "__call__", lambda *of: calls.append(of) or right(*of))
    scenario = job.tests[0].test.scenario

    def run():
        controller = ForeignSimulator(spec)
        assert list(reuse_notes(job, controller)) == []
        return simulator_for(job, controller)(scenario, job.parameters).segments[0]["i_a_a"].tobytes()

    assert run() == run()
    assert len(calls) == 1
    (folder / "gains.csv").write_text("2")
    run()
    assert len(calls) == 2
    (folder / "mine.py").write_text(f"{CLASS}\n# edited")
    run()
    assert len(calls) == 3


def test_what_runs_behind_an_address_is_never_reused(tmp_path):
    """Files say nothing of a program that runs already; nor of a class that was made in this process."""
    from pvlvrt_compliance.controllers.here import SimulatorHere
    from pvlvrt_compliance.controllers.program.door import ProgramDoor

    door = ProgramDoor.__new__(ProgramDoor)
    door._spec = "tcp://localhost:1"
    assert (door.may_be_listed(), door.besides()) == (False, "it is not known what program runs behind an address")
    space = {}
    exec(CLASS, space)
    controller = SimulatorHere(space["Mine"])
    job = make_job(Asked(profiles=(IEC,), reuse=str(tmp_path)))
    (note,) = reuse_notes(job, controller)
    assert note.endswith("no records are reused: it is made in this process, not from a file")
    assert simulator_for(job, controller) is controller
