"""A controller that is given in Python: where it runs, and that it does the same there as in a process of its own."""

import importlib.util
import sys
import threading
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.here import SimulatorHere, name_of, spec_of
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import PvlvrtError, SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from waiting import PATIENCE_S, wait_until

SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)


def class_of(file, name):
    """A class of a file in this folder; its module can be imported by no name."""
    path = Path(__file__).with_name(file)
    specification = importlib.util.spec_from_file_location(f"{path.stem}_of_a_test", path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return getattr(module, name)


Small, Controller = class_of("small.py", "Small"), class_of("misbehaving.py", "Controller")
QUICK = parameters_from(("simulation.settling_s=0.2",))


def test_the_same_record_as_in_a_process_of_its_own(opened):
    """Bit for bit: one loop runs both."""
    (here,) = SimulatorHere(Small, {"gain": 0.99})(SCENARIO, QUICK)
    (apart,) = opened("small.py:Small", gain=0.99)(SCENARIO, QUICK)
    assert list(here.channels) == list(apart.channels)
    assert all(np.array_equal(here[name], apart[name]) for name in here.channels)


def test_every_test_has_a_controller_of_its_own():
    """Nothing is left of the run before, but for what a class keeps itself."""
    before = Controller.count
    simulator = SimulatorHere(Controller)
    first, second = (simulator(SCENARIO, QUICK).segments[0] for _ in range(2))
    assert np.array_equal(first["i_a_a"], second["i_a_a"])
    assert Controller.count == before + 2


@pytest.mark.parametrize("deed", ["raise", "nan", "range", "two", "none", "words", "sys.exit"])
def test_what_it_does_wrong_is_an_error_of_its_test(deed, capsys):
    """As from a process of its own; what it prints is printed."""
    with pytest.raises(SimulationError, match="controller"):
        SimulatorHere(Controller, {"deed": deed})(SCENARIO, QUICK)
    assert f"about to {deed}" in capsys.readouterr().out
    assert SimulatorHere(Controller)(SCENARIO, QUICK).end_s > 0.4


def test_a_function_that_makes_it():
    """Its keyword arguments with defaults are the parameters, as of a class."""

    def make(gain: float = 0.5):
        return Small(gain)

    for factory in (make, partial(Small, gain=0.5), lambda: Small(0.5)):
        made = SimulatorHere(factory)
        assert made.description.sample_time_s == 1e-4
    assert [p.name for p in SimulatorHere(make).description.parameters] == ["gain"]


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (3, "give a class, a function that makes it, or a controller that is made already"),
        (dict, "has no attribute sample_time_s"),
        (type("Half", (), {"sample_time_s": 1e-4, "reset": print}), "has no method step"),
        (type("Fails", (), {"__init__": lambda _: 1 / 0}), "ZeroDivisionError"),
        (partial(Small, 1, 2), "cannot be made: TypeError"),
    ],
)
def test_what_is_no_controller(given, says):
    """It is refused before anything is simulated, with the reason."""
    with pytest.raises(UsageError, match=says):
        SimulatorHere(given)


def test_a_parameter_that_it_has_not():
    """It is told by its name, with those that there are."""
    with pytest.raises(UsageError, match=r"controller.gian: .*did you mean \"gain\"\?; it has gain"):
        SimulatorHere(Small, {"gian": 1.0})


def test_a_class_of_a_file_is_named_by_it(tmp_path, monkeypatch):
    """The file is named from the working folder where it stands there, else in full."""
    (tmp_path / "mine_alone.py").write_text("class Mine:\n    class Inner:\n        pass\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    from mine_alone import Mine

    assert spec_of(Mine) == f"{(tmp_path / 'mine_alone.py').resolve()}:Mine"
    monkeypatch.chdir(tmp_path)
    assert spec_of(Mine) == "mine_alone.py:Mine"
    assert spec_of(Mine.Inner) is None
    monkeypatch.setattr(sys.modules["mine_alone"], "Mine", object)
    assert spec_of(Mine) is None, "what the file's name leads to is another class"


@pytest.mark.parametrize(
    "made",
    [
        *(type("Local", (), {}), type("Script", (), {"__module__": "__main__"})),
        *(lambda: None, SimulatorHere, dict, partial(Small), Small),
    ],
    ids=name_of,
)
def test_what_no_file_leads_to(made):
    """Local classes, functions, parts of a package and the script that is running cannot be had by a file."""
    assert spec_of(made) is None


HOURS = SCENARIO.model_copy(update={"duration_s": 3600.0})


def stopped(simulator, is_at_it):
    """Errors of a run that another thread stops once it is at it."""
    ends = []

    def run():
        try:
            simulator(HOURS, QUICK)
        except PvlvrtError as error:
            ends.append(str(error))

    thread = threading.Thread(target=run)
    thread.start()
    is_at_it()
    simulator.stop()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()
    return ends


def test_stopping():
    """A run in another thread ends with its next sample."""
    begun = threading.Event()

    class Slow(Small):
        def step(self, y):
            begun.set()
            return super().step(y)

    (said,) = stopped(SimulatorHere(Slow), lambda: begun.wait(PATIENCE_S))
    assert said.startswith("the controller failed at")


def test_stopping_one_in_a_process_of_its_own(opened, tmp_path):
    """Its process ends, and the next run has another."""
    (tmp_path / "telling.py").write_text(TELLING)
    seen = tmp_path / "seen"
    simulator = ForeignSimulator(f"{tmp_path / 'telling.py'}:Telling", {"seen": str(seen)})
    (said,) = stopped(simulator, lambda: wait_until(seen.exists, "the first sample"))
    assert "the process for the controller has ended" in said or "SIGKILL" in said
    assert opened("small.py:Small")(SCENARIO, QUICK).end_s > 0.4


TELLING = """
class Telling:
    sample_time_s = 1e-4

    def __init__(self, seen=""):
        self.seen = seen

    def reset(self, nominal):
        pass

    def step(self, y):
        open(self.seen, "w").close()
        return y.m_a, y.m_b, y.m_c
"""
