"""A second rate beside the fast one, of a program."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.in_process import Debugged
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from

PROGRAM = Path(__file__).with_name("slow_program.py")
SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
QUICK = parameters_from(("simulation.settling_s=0.2",))


def program(*arguments):
    """The program, as a controller."""
    return " ".join([f'stdio:"{sys.executable}" "{PROGRAM}"', *arguments])


@pytest.mark.parametrize("mode", ["json", "binary"])
def test_it_runs_where_that_of_a_class_does(opened, mode):
    """In the first sample and every 25th after it; the whole record is that of the class, bit for bit."""
    (mine,) = ForeignSimulator(program(mode))(SCENARIO, QUICK).segments
    (theirs,) = opened("slow.py:Slow")(SCENARIO, QUICK).segments
    assert set(mine.channels) == set(theirs.channels)
    assert all(np.array_equal(mine[name], theirs[name]) for name in mine.channels)
    (debugged,) = Debugged(program(mode), {})(SCENARIO, QUICK).segments
    assert all(np.array_equal(mine[name], debugged[name]) for name in mine.channels)
    assert np.array_equal(mine["slow"], np.ceil(mine["fast"] / 25))
    assert np.array_equal(mine["together"], mine["slow"])
    assert mine["slow"][-1] > 20


def test_its_period_is_told(opened):
    """By a class as by a program; of a program that no input tells when it is due, that, too."""
    said = ("its slow task runs every 25 samples, 2.5 ms",)
    assert opened("slow.py:Slow").description.notes == said
    assert ForeignSimulator(program("json")).description.notes == said
    period, untold = ForeignSimulator(program("json", "untied")).description.notes
    assert (period,) == said
    assert untold.startswith("none of its inputs is tied to slow_task_due")


@pytest.mark.parametrize("every", [0, -1, 2.5, "often", 2_000_000])
def test_a_period_that_is_none(tmp_path, every):
    """It is refused by its key, with what is allowed."""
    hello = json.dumps({"version": 1, "sample_time_s": 1e-4, "every": every})
    (tmp_path / "program.py").write_text(f"input()\nprint({hello!r}, flush=True)\ninput()\n")
    with pytest.raises(UsageError, match=r"its answer to the hello cannot be used: 1 problem\n  every: must be "):
        ForeignSimulator(f'stdio:"{sys.executable}" "{tmp_path / "program.py"}"')


LATE = """
import json, sys, time
input()
print(json.dumps({"version": 1, "sample_time_s": 1e-4}), flush=True)
if "start" in input():
    print('{"ready": true}', flush=True)
    for k, line in enumerate(sys.stdin):
        if "end" in line:
            break
        time.sleep(1.5 if k == 5 else 0)
        print(json.dumps({name: json.loads(line)[name] for name in ("m_a", "m_b", "m_c")}), flush=True)
"""


def test_one_that_is_debugged_may_be_late(tmp_path, monkeypatch):
    """However long it is looked at; where a time is set for its answers, that holds."""
    monkeypatch.setattr("pvlvrt_compliance.controllers.program.door._REPLY_S", 0.2)
    (tmp_path / "late.py").write_text(LATE)
    spec = f'stdio:"{sys.executable}" "{tmp_path / "late.py"}"'
    assert Debugged(spec, {})(SCENARIO, QUICK).end_s > 0.4
    with pytest.raises(SimulationError, match=r"did not answer within 0\.2 s"):
        Debugged(spec, {"reply_timeout_s": 0.2})(SCENARIO, QUICK)
