"""A controller that is run in this process: the same record as apart, and what ends a run is not taken for its own."""

import bdb
import json
import math
import shutil
import signal
import tempfile
import threading
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.debugging import is_debugged
from pvlvrt_compliance.controllers.here import SimulatorHere
from pvlvrt_compliance.controllers.in_process import Debugged
from pvlvrt_compliance.controllers.limits import Limits, limits_here
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from

FOLDER = Path(__file__).parent
SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
QUICK = parameters_from(("simulation.settling_s=0.2",))

SMALL = (FOLDER / "small.py").read_text("utf-8")


class Small:
    """As that of small.py."""

    sample_time_s = 1e-4

    def __init__(self, gain=1.0):
        self.gain = gain

    def reset(self, nominal):
        """Nothing is kept."""

    def step(self, y):
        """Hold what is."""
        return self.gain * y.m_a, self.gain * y.m_b, self.gain * y.m_c


def same(one, other):
    """Whether two records have the same channels, bit for bit."""
    (a,), (b,) = one.segments, other.segments
    return list(a.channels) == list(b.channels) and all(np.array_equal(a[name], b[name]) for name in a.channels)


def test_a_debugged_class_gives_the_record_that_it_gives_apart(opened):
    """One loop runs both; the second run is as the first."""
    debugged = Debugged(f"{FOLDER / 'small.py'}:Small", {"gain": 0.99})
    apart = opened("small.py:Small", gain=0.99)(SCENARIO, QUICK)
    assert same(debugged(SCENARIO, QUICK), apart)
    assert same(debugged(SCENARIO, QUICK), apart)
    assert debugged.description == opened("small.py:Small", gain=0.99).description


@pytest.mark.compiler
def test_a_debugged_library_has_globals_of_its_own_for_each_test(compiled):
    """One that counts in a global gives the same record again, and that which it gives apart."""
    library = str(compiled("commanding.c"))
    debugged, apart = Debugged(library, {}), ForeignSimulator(library)
    record = debugged(SCENARIO, QUICK)
    assert same(record, apart(SCENARIO, QUICK))
    assert same(record, debugged(SCENARIO, QUICK))
    assert record.segments[0]["initialised"].max() > 100, "what is counted in the global"


def test_a_file_that_changes_between_two_tests(tmp_path):
    """The verdicts would be on two controllers: the second test is an error."""
    file = tmp_path / "mine.py"
    shutil.copy(FOLDER / "small.py", file)
    debugged = Debugged(f"{file}:Small", {})
    debugged(SCENARIO, QUICK)
    file.write_text(f"{file.read_text()}# another\n")
    with pytest.raises(SimulationError, match="has changed since the first test"):
        debugged(SCENARIO, QUICK)


LOOKING = f"""{SMALL}
import json, tempfile
from pvlvrt_compliance.controllers.debugging import is_debugged
from pvlvrt_compliance.controllers.limits import limits_here

class Looking(Small):
    def __init__(self, seen=""):
        super().__init__()
        self.seen = seen

    def reset(self, nominal):
        with open(self.seen, "w") as file:
            json.dump([limits_here().files_mb, is_debugged(), tempfile.gettempdir()], file)
"""


def test_no_limit_holds_while_it_is_debugged(tmp_path):
    """Afterwards all is as it was; its temporary files lie in a folder apart, which is there until the process ends."""
    (tmp_path / "looking.py").write_text(LOOKING)
    before = tempfile.gettempdir()
    Debugged(f"{tmp_path / 'looking.py'}:Looking", {"seen": str(tmp_path / "seen")})(SCENARIO, QUICK)
    files_mb, was_debugged, folder = json.loads((tmp_path / "seen").read_text())
    assert (files_mb, was_debugged) == (math.inf, True)
    assert Path(folder).parent == Path(before)
    assert Path(folder).is_dir()
    assert (limits_here(), is_debugged(), tempfile.gettempdir()) == (Limits(), False, before)


def raising(what, where):
    """A class that raises something in one of its methods."""

    def raises(*_):
        raise what

    return type("Raising", (Small,), {where: raises})


@pytest.mark.parametrize("where", ["step", "reset", "signals"])
def test_ctrl_c_ends_the_run_wherever_it_comes(where):
    """It is no error of the controller, as all else is that it raises."""
    with pytest.raises(KeyboardInterrupt, match="now"):
        SimulatorHere(raising(KeyboardInterrupt("now"), where))(SCENARIO, QUICK)
    with pytest.raises(SimulationError, match="ZeroDivisionError: now"):
        SimulatorHere(raising(ZeroDivisionError("now"), where))(SCENARIO, QUICK)


def test_a_signal_that_comes_between_two_samples():
    """Where it meets no function of the controller, but one that is being entered, it ends the run all the same."""

    class Sending(Small):
        def step(self, y):
            if y.time_s > 0.1:
                # Beside this thread, so that it is seen where the next function begins, whichever that is.
                threading.Thread(target=signal.raise_signal, args=(signal.SIGINT,)).start()
            return super().step(y)

        def signals(self):
            return {"gain": self.gain}

    for _ in range(20):
        with pytest.raises(KeyboardInterrupt):
            SimulatorHere(Sending)(SCENARIO, QUICK)


@pytest.mark.parametrize("where", ["step", "reset", "signals"])
def test_ctrl_c_in_the_middle_of_a_lock(where):
    """What unwinds it raises an error of its own (`release unlocked lock`), which is not the controller's."""

    def unwinds(*_):
        try:
            raise KeyboardInterrupt("now")
        finally:
            raise RuntimeError("release unlocked lock")

    with pytest.raises(KeyboardInterrupt, match="now"):
        SimulatorHere(type("Locking", (Small,), {where: unwinds}))(SCENARIO, QUICK)


def test_ctrl_c_as_it_is_made():
    """It comes through then, too."""
    with pytest.raises(KeyboardInterrupt):
        SimulatorHere(raising(KeyboardInterrupt, "__init__"))


def test_a_debugger_that_is_left_ends_the_run():
    """As Ctrl-C does: the command says what is finished, and nothing is the controller's error."""
    with pytest.raises(KeyboardInterrupt, match="the debugger was left"):
        SimulatorHere(raising(bdb.BdbQuit, "step"))(SCENARIO, QUICK)


def test_an_exit_is_the_controllers_own():
    """It ends a test, not the run."""
    with pytest.raises(SimulationError, match="SystemExit: 3"):
        SimulatorHere(raising(SystemExit(3), "step"))(SCENARIO, QUICK)


def test_apart_a_breakpoint_says_what_it_needs(tmp_path):
    """There is no terminal: the test is an error that names the option."""
    (tmp_path / "stopping.py").write_text(STOPPING)
    with pytest.raises(SimulationError, match=r"breakpoint\(\) needs --debug"):
        ForeignSimulator(f"{tmp_path / 'stopping.py'}:Stopping")(SCENARIO, QUICK)


STOPPING = f"""{SMALL}

class Stopping(Small):
    def step(self, y):
        breakpoint()
        return super().step(y)
"""


def test_what_cannot_be_opened():
    """It is told as without, and by the specification."""
    with pytest.raises(UsageError, match=r"controller absent\.py:Mine: there is no file absent\.py"):
        Debugged("absent.py:Mine", {})


class TestMadeAlready:
    """A controller that is given as an object."""

    def test_each_test_has_a_copy(self):
        """The record is that of its class, and what is given stays as it was."""

        class Counting(Small):
            seen = 0

            def step(self, y):
                self.seen += 1
                return super().step(y)

            def signals(self):
                return {"seen": self.seen}

        given = Counting(0.99)
        simulator = SimulatorHere(given)
        first = simulator(SCENARIO, QUICK)
        assert same(first, simulator(SCENARIO, QUICK))
        assert same(first, SimulatorHere(Counting, {"gain": 0.99})(SCENARIO, QUICK))
        assert given.seen == 0

    def test_it_is_as_it_was_when_it_was_given(self):
        """What is changed afterwards is not in it."""
        given = Small(0.99)
        simulator = SimulatorHere(given)
        given.gain = 0.5
        assert same(simulator(SCENARIO, QUICK), SimulatorHere(Small, {"gain": 0.99})(SCENARIO, QUICK))

    def test_its_attributes_tell_how_it_was_made(self):
        """In the provenance; set they cannot be."""
        values = SimulatorHere(Small(0.99)).parameter_values()
        assert values == {"gain": 0.99, "sample_time_s": 1e-4}
        with pytest.raises(UsageError, match=r"controller\.gain: .* takes no parameters; give its class"):
            SimulatorHere(Small(), {"gain": 0.5})

    def test_what_cannot_be_copied(self):
        """It is refused, with what to give instead."""
        given = Small()
        given.lock = threading.Lock()
        with pytest.raises(UsageError, match=r"Small: it cannot be copied.*give its class.*TypeError"):
            SimulatorHere(given)


def test_the_digest_is_of_the_source_with_that_of_its_bases():
    """Without a source it is of the name, which is noted."""

    class Derived(Small):
        pass

    without = type("Nowhere", (Small,), {"__module__": "nowhere"})
    exec("class Typed:\n    sample_time_s = 1e-4\n    reset = step = print", typed := {"__name__": "typed"})
    digests = [SimulatorHere(made).description for made in (Small, Derived, Small(), typed["Typed"])]
    assert digests[0].digest == digests[2].digest != digests[1].digest
    assert all(not found.notes for found in digests[:3])
    assert digests[3].notes == ("its source is not at hand: the digest is of its name alone",)
    assert SimulatorHere(without).description.digest not in {found.digest for found in digests}
