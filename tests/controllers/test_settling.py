"""Runs of a controller from outside go on from one settled state where its door allows that, and say where not."""

import sys
from pathlib import Path

import pytest
from remembering import Remembering
from settled_runs import SAGS, both, settling

from pvlvrt_compliance.controllers.here import SimulatorHere
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from same_records import are_the_same

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[1]
FILE = FOLDER / "remembering.py"


@pytest.mark.parametrize(
    "settings",
    [
        (),
        ("simulation.record_settling=true",),
        (
            *("controller.computation_delay_samples=2", "sensors.measurement_delay_samples=3"),
            *("sensors.voltage_noise_v=1", "simulation.time_limit_s=900"),  # in which a loop with hardware is compiled
        ),
        ("controller.hold=run",),
    ],
    ids=" ".join,
)
def test_a_class_goes_on_from_where_it_was(settings):
    """Samples of its own clock, its own signals, the hardware around it: all bits are those of one run."""
    assert both(ForeignSimulator(f"{FILE}:Remembering"), parameters=parameters_from(settings)) == ([True] * 3, [])


def test_the_template_goes_on_from_where_it_was():
    """A controller that controls: integrators, resonators, what synchronises."""
    file = ROOT / "pvlvrt_compliance" / "controllers" / "templates" / "python" / "controller.py"
    assert both(ForeignSimulator(f"{file}:Controller")) == ([True] * 3, [])


def test_a_class_of_this_process_goes_on_from_where_it_was():
    """One of a notebook, which is pickled here."""
    assert both(SimulatorHere(Remembering)) == ([True] * 3, [])


@pytest.mark.compiler
def test_a_library_goes_on_from_where_it_was(compiled):
    """The bundled controller in C keeps its states where the interface has them."""
    library = compiled(ROOT / "examples" / "bundled-controller-c" / "controller.c")
    controller = ForeignSimulator(str(library))
    assert both(controller) == ([True] * 3, [])
    assert controller.notes == []


def test_settling_is_simulated_once(tmp_path):
    """The third test has the controller called for its own part alone; the first is run both ways, to be sure."""
    log = tmp_path / "log"
    controller = ForeignSimulator(f"{FILE}:Remembering", {"log": str(log)})
    settles, _ = settling(controller, SAGS)
    calls, before = [], 0
    for scenario in SAGS:
        controller(scenario, Parameters(), settles)
        calls.append(log.stat().st_size - before)
        before = log.stat().st_size
    settled, own = 2000 + 10_000 + 2499, 2502  # samples of 0.1 ms: held, settling, up to the sag; and the rest
    assert calls == pytest.approx([2 * settled + 2 * own, own, own], abs=6)


@pytest.mark.parametrize(
    ("name", "why"), [("InItsModule", "came out otherwise"), ("WithAFunction", "WithAFunction cannot be pickled")]
)
def test_what_its_door_does_not_find_is_said(name, why):
    """State in the module, or in what cannot be pickled: each test settles for itself, and that is told once."""
    same, told = both(ForeignSimulator(f"{FILE}:{name}"))
    assert same == [True] * 3
    assert len(told) == 1
    assert why in told[0]
    assert told[0].startswith("not settled once")


def test_a_program_is_run_whole():
    """What another program remembers is its own affair."""
    spec = f'stdio:"{sys.executable}" "{ROOT / "examples" / "program-python" / "controller.py"}"'
    same, told = both(ForeignSimulator(spec), SAGS[:2])
    assert same == [True] * 2
    assert told == ["not settled once, each test settles for itself: a program does not give what it remembers"]


@pytest.mark.compiler
def test_a_library_without_states_is_run_whole(compiled):
    """States that are not in the arrays of the interface are not known."""
    same, told = both(ForeignSimulator(str(compiled("commanding.c"))), SAGS[:2])
    assert same == [True] * 2
    assert len(told) == 1
    assert "keeps no state in the arrays of the interface" in told[0]


def test_what_fails_says_what_it_says_in_one_run():
    """A controller that fails in the sag fails at the same instant in the same words, though it has gone on."""
    controller = ForeignSimulator(f"{FILE}:Failing")
    settles, told = settling(controller, SAGS)
    for scenario in SAGS:
        with pytest.raises(SimulationError) as of_one_run:
            controller(scenario, Parameters())
        with pytest.raises(SimulationError, match="no more than 15 000") as gone_on:
            controller(scenario, Parameters(), settles)
        assert str(gone_on.value) == str(of_one_run.value)
    assert told == []


def test_a_state_of_another_controller_is_refused():
    """What is put back must be what was taken: else the test is run whole."""
    controller = ForeignSimulator(f"{FILE}:Remembering")
    settles, _ = settling(controller, SAGS)
    controller(SAGS[0], Parameters(), settles)
    ((key, kept),) = settles._starts._kept.items()
    settles._starts._kept[key] = kept._replace(state=b"nothing")
    assert are_the_same(controller(SAGS[1], Parameters(), settles), controller(SAGS[1], Parameters()))
