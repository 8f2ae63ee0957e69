"""Other programs as controllers: the examples, the protocol, and programs that do not keep to it."""

import json
import re
import shutil
import socket
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.program.hello import greeting, hello_in
from pvlvrt_compliance.controllers.program.link import command_of, link_to
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from waiting import PATIENCE_S, doubled

FOLDER = Path(__file__).parent
EXAMPLES = FOLDER.parents[2] / "examples"
QUICK = parameters_from(("simulation.settling_s=0.02", "simulation.synchronising_s=0.01"))
NO_RELAYS = parameters_from(
    ("simulation.settling_s=0.02", "simulation.synchronising_s=0.01", "protection.overcurrent_pu=100")
)
"""Nothing trips: a controller that goes on with what modulates loses its plant, and what it does wrong counts."""

SHORT = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
PYTHON_EXAMPLE = f'stdio:"{sys.executable}" "{EXAMPLES / "program-python" / "controller.py"}"'


@pytest.fixture(scope="session")
def c_example(tmp_path_factory):
    """Give the example in C, compiled."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    program = tmp_path_factory.mktemp("program") / "controller"
    source = EXAMPLES / "program-c" / "controller.c"
    subprocess.run([compiler, "-O2", "-Wall", "-Werror", "-o", str(program), str(source), "-lm"], check=True)
    return f"stdio:{program}"


def program(*arguments):
    """Program that behaves as it is told, as a controller."""
    return " ".join([f'stdio:"{sys.executable}" "{FOLDER / "programs.py"}"', *arguments])


def furthest(mine, theirs, names):
    """Largest difference of two records, by the largest value of each channel."""
    pairs = [(mine.segments[0][name], theirs.segments[0][name]) for name in names]
    return max(np.abs(a - b).max() / max(np.abs(b).max(), 1e-3) for a, b in pairs)


def test_example_in_python_rides_through():
    """The example in Python stays connected in a sag of 90 % and comes back to nominal power."""
    record = ForeignSimulator(PYTHON_EXAMPLE)(Scenario(sag=Sag(depth=0.9), duration_s=0.2), parameters_from(()))
    assert_rides_through(record.segments[0])


@pytest.mark.compiler
def test_examples_are_alike(c_example):
    """The example in C, by packed frames, rides through and gives what the one in Python gives by lines of JSON."""
    scenario, parameters = Scenario(sag=Sag(depth=0.6, phases="c"), duration_s=0.1), parameters_from(())
    mine, theirs = ForeignSimulator(c_example)(scenario, parameters), ForeignSimulator(PYTHON_EXAMPLE)
    assert_rides_through(mine.segments[0])
    assert furthest(mine, theirs(scenario, parameters), ("i_a_a", "v_dc_v", "m_alpha", "v_fault_pu")) < 1e-9


def assert_rides_through(samples):
    """Connected throughout, currents within 1.3 pu, nominal power at the end."""
    power = sum(samples[f"u_{x}_v"] * samples[f"i_{x}_a"] for x in "abc")[-500:].mean()
    assert samples["connected"].min() == 1
    assert max(np.abs(samples[f"i_{x}_a"]).max() for x in "abc") < 1.3 * 1025
    assert power == pytest.approx(500e3, rel=0.02)


@pytest.mark.parametrize("mode", ["json", "binary"])
def test_either_mode_gives_what_a_class_gives(opened, mode):
    """A program does what the same in Python does, with wide ports, too; its parameters reach it."""
    simulator = ForeignSimulator(program(mode), {"gain": 0.98})
    theirs = opened("small.py:Small", gain=0.98)(SHORT, QUICK)
    assert furthest(simulator(SHORT, QUICK), theirs, ("i_a_a", "v_dc_v", "m_alpha", "m_beta")) < 1e-12


@pytest.mark.parametrize("mode", ["json", "binary"])
def test_over_tcp(opened, mode):
    """A program that listens is asked for every run anew."""
    with listening(mode) as port:
        simulator = ForeignSimulator(f"tcp://127.0.0.1:{port}")
        theirs = opened("small.py:Small")(SHORT, QUICK)
        for _ in range(2):
            assert furthest(simulator(SHORT, QUICK), theirs, ("i_a_a", "v_dc_v", "m_alpha", "m_beta")) < 1e-12


@contextmanager
def listening(mode):
    """Have a program listen; give its port."""
    command = [sys.executable, str(FOLDER / "programs.py"), mode, "--listen"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield int(process.stdout.readline())
        finally:
            process.kill()


@pytest.mark.parametrize("mode", ["json", "binary"])
@pytest.mark.parametrize(
    ("what", "reason"),
    [
        ("dies", "(?s)at 0.07.*ended with status 3.*no more sense"),
        ("garbage", "(?s)at 0.07.*(not a JSON object|beginning with b'what)"),
        ("twice", "(?s)at 0.07.*(more than the one line|more than one frame)"),
        ("half", "(?s)at 0.07.*ended with status 0"),
        ("nan", "(?s)not a finite number at 0.07.*m_a = nan"),
        ("huge", "(?s)out of range at 0.07"),
        ("gives-up", "(?s)at 0.07.*gave up: the link has lost its voltage"),
    ],
)
def test_programs_that_fail(mode, what, reason):
    """Whatever a program does at 0.07 s ends the run there, with the reason."""
    with pytest.raises(SimulationError, match=reason):
        ForeignSimulator(program(mode, what))(SHORT, NO_RELAYS)


@pytest.mark.parametrize("mode", ["json", "binary"])
@pytest.mark.parametrize("what", ["dies", "garbage", "twice", "half", "nan", "huge", "gives-up"])
def test_programs_that_fail_after_a_trip(mode, what):
    """Once the relay has tripped none of that ends the run: it is noted, and the record goes on to its end."""
    simulator = ForeignSimulator(program(mode, what))
    record = simulator(SHORT, QUICK)
    assert record.end_s == pytest.approx(SHORT.end_s, abs=1e-4)
    assert record.segments[0]["connected"][-1] == 0
    assert record.segments[0]["trip_cause"][-1] > 0
    assert any(note.startswith("ignored, as it came after a trip: ") for note in simulator.notes)


@pytest.mark.parametrize("mode", ["json", "binary"])
def test_program_that_hangs(mode):
    """A program that answers no more is given up after the time that is set, and told with the simulated time.

    On a machine that has other things to do it may be late before; it is then given twice the time.
    """
    for limit_s in doubled(0.5):
        with pytest.raises(SimulationError, match=f"(?s) at .*did not answer within {limit_s:g} s") as error:
            ForeignSimulator(program(mode, "hangs"), {"reply_timeout_s": limit_s})(SHORT, NO_RELAYS)
        if "at 0.07" in str(error.value):
            return


@pytest.mark.parametrize(
    ("what", "reason"),
    [
        ("no-output", "there is no 'm'"),
        ("word", "a number is due"),
        ("narrow", "a list of 3 numbers is due"),
    ],
)
def test_answers_that_do_not_fit(what, reason):
    """An answer in JSON without a number where one is due is refused, and shown."""
    with pytest.raises(SimulationError, match=reason):
        ForeignSimulator(program("json", what))(SHORT, NO_RELAYS)


@pytest.mark.parametrize(
    ("what", "reason"),
    [
        ("silent", "(?s)status 0"),
        ("prints", "'Hello!', which is not a JSON object"),
        ("old", "version: "),
        ("typo", 'sampel_time_s: unknown key; did you mean "sample_time_s"'),
        ("raises", "(?s)status 1.*ZeroDivisionError"),
        ("refuses", "gave up: no licence"),
    ],
)
def test_bad_hello(what, reason):
    """A program that does not say what it is, is refused before anything runs, with what it wrote to stderr."""
    with pytest.raises(UsageError, match=reason):
        ForeignSimulator(program("json", what))


def test_hello_is_told_in_the_words_of_files():
    """All that is wrong with a hello is told at once, by key, with what is allowed and what was meant."""
    ports = [{"name": "Va", "untt": "V"}, 3]
    answer = {"version": 1, "mode": "text", "inputs": ports, "parameters": {"gain": {"value": 1, "minimun": 0}}}
    with pytest.raises(DoorError) as caught:
        hello_in(json.dumps(answer).encode())
    head, *problems = str(caught.value).splitlines()
    assert head == "its answer to the hello cannot be used: 5 problems"
    assert problems == [
        "  sample_time_s: missing",
        "  mode: must be 'json' or 'binary', not 'text'",
        '  inputs[0].untt: unknown key; did you mean "unit"?',
        "  inputs[1].name: must be a text, not 3",
        '  parameters.gain.minimun: unknown key; did you mean "minimum"?',
    ]


def test_not_ready():
    """A program may refuse to start."""
    with pytest.raises(SimulationError, match="gave up: not in this mood"):
        ForeignSimulator(program("json", "moody"))(SHORT, QUICK)


@pytest.mark.parametrize(
    ("parameter", "is_whole"),
    [
        ({"value": 1}, True),
        ({"value": 1, "unit": "-", "minimum": 0, "maximum": 2}, True),
        ({"value": 1, "minimum": 0.5, "maximum": 2}, False),
        ({"value": 1, "maximum": 1.2}, False),
        ({"value": 1, "unit": "pu"}, False),
        ({"value": 20, "unit": "mHz/s"}, False),
        ({"value": True, "unit": "pu"}, False),
    ],
)
def test_a_default_without_a_fraction(parameter, is_whole):
    """There are languages that write 1.0 as 1: a unit, or a range with a fraction, says that it is no whole number."""
    hello = {"version": 1, "sample_time_s": 1e-4, "parameters": {"p": parameter}}
    (info,) = hello_in(json.dumps(hello).encode()).parameter_infos()
    assert (type(info.value) is int) is is_whole
    assert info.value == parameter["value"]


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"gian": 1.0}, 'did you mean "gain"'),
        ({"gain": 3.0}, "out of range; 0 to 2 is allowed"),
        ({"gain": "x"}, "a number"),
    ],
)
def test_parameters(given, reason):
    """Parameters are checked against what the program says of them."""
    with pytest.raises(UsageError, match=reason):
        ForeignSimulator(program("json"), given)


@pytest.mark.parametrize("spec", ["stdio:", "stdio:'", "tcp://127.0.0.1", "tcp://127.0.0.1:port", "tcp://:5"])
def test_bad_specification(spec):
    """What cannot be a command or an address is refused."""
    with pytest.raises(DoorError, match=r"write|not a command"):
        link_to(spec, 1.0)


def test_nothing_there():
    """A program that cannot be started or reached is refused."""
    with pytest.raises(DoorError, match="cannot be started"):
        link_to("stdio:/no/such/program", 1.0)
    with socket.socket() as taken:  # so that nobody else listens there meanwhile
        taken.bind(("127.0.0.1", 0))
        with pytest.raises(DoorError, match="nothing answers"):
            link_to(f"tcp://127.0.0.1:{taken.getsockname()[1]}", PATIENCE_S)


def test_command_is_not_for_a_shell():
    """Words are split as by a shell, and nothing else of one is there."""
    assert command_of("stdio:python3 'my ctrl.py' $HOME;ls") == ["python3", "my ctrl.py", "$HOME;ls"]


def test_listener_that_says_nothing():
    """A program that takes the connection and closes it is refused."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=_take_and_close, args=(server,)).start()
        with pytest.raises(UsageError, match="closed the connection"):
            ForeignSimulator(f"tcp://127.0.0.1:{server.getsockname()[1]}")


def _take_and_close(server):
    server.accept()[0].close()


def test_page_of_the_protocol():
    """The messages on the page are those of the protocol."""
    page = (EXAMPLES.parent / "docs" / "controllers" / "program.md").read_text("utf-8")
    host, answer, start, slow = (json.loads(text) for text in re.findall(r"```json\n(.*?)```", page, re.DOTALL))
    assert hello_in(json.dumps(answer).encode()).inputs[1].width == 3
    assert hello_in(json.dumps(slow).encode()).every == 25
    assert host.keys() == json.loads(greeting({})).keys()
    assert start["start"].keys() == {"nominal", "parameters"}
