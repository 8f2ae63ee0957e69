"""FMUs go on from one settled state where they say that they can, by the rules of the standard."""

import ctypes

import pytest
from settled_runs import SAGS, both, settling
from stateful_fmu import SAYS, made

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.fmu.door import FmuDoor
from pvlvrt_compliance.controllers.resting import unpacked
from pvlvrt_compliance.controllers.settling import SettledController
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.units import Nominal
from same_records import are_the_same

pytestmark = [pytest.mark.compiler, pytest.mark.slow]

VERSIONS = pytest.mark.parametrize("version", [2, 3])
TWO = SAGS[:2]
OTHER_SIZE = "the state has another size"
IN_THE_SAG_S = 1.45
"""By the FMU's time, which begins 1.2 s before the record; the sag begins 0.25 s into it."""


@pytest.fixture(scope="session")
def stateful(tmp_path_factory):
    """FMU that gives all of its state, by FMI's version."""
    folder = tmp_path_factory.mktemp("stateful")
    files = {}

    def stateful(version):
        if version not in files:
            files[version] = made(folder / f"fmi{version}", version)
        return files[version]

    return stateful


@VERSIONS
def test_an_fmu_goes_on_from_where_it_was(stateful, version):
    """All bits are those of one run; it fails where it is asked out of turn, and ends a process that leaves a state."""
    controller = ForeignSimulator(stateful(version))
    settles, told = settling(controller, SAGS)
    records = [controller(scenario, Parameters(), settles) for scenario in SAGS]
    assert settles._is_sure
    assert all(are_the_same(one, controller(sag, Parameters())) for one, sag in zip(records, SAGS, strict=True))
    assert (told, controller.notes) == ([], [])


@VERSIONS
def test_it_is_told_as_of_one_run(stateful, version):
    """A warning without a word is told by what was logged last, be that long before."""
    controller = ForeignSimulator(stateful(version), {"warns_at_s": IN_THE_SAG_S})
    assert both(controller, TWO) == ([True] * 2, [])
    assert controller.notes == ["the first step"]


@VERSIONS
def test_one_that_leaves_out_part_of_its_state_is_run_whole(tmp_path, version):
    """It is seen in the first test that goes on, and told once."""
    same, told = both(ForeignSimulator(made(tmp_path / "it", version, "FORGETS")), TWO)
    assert same == [True] * 2
    assert len(told) == 1
    assert "came out otherwise than in one run" in told[0]


@VERSIONS
@pytest.mark.parametrize("said", [0, 1, 2], ids=["neither", "no serialisation", "no states"])
def test_one_that_does_not_say_that_it_can_is_run_whole(tmp_path, version, said):
    """What its description lacks is told in its own words; no function of its binary is called."""
    both_attributes = SAYS[version]
    says = ((), both_attributes[:1], both_attributes[1:])[said]
    same, told = both(ForeignSimulator(made(tmp_path / "it", version, "REFUSES", says=says)), TWO)
    assert same == [True] * 2
    lacks = " and ".join(f'{name}="true"' for name in both_attributes if name not in says)
    why = f"its modelDescription.xml lacks {lacks}: its state cannot be taken to another process"
    assert told == [f"not settled once, each test settles for itself: {why}"]


@VERSIONS
def test_one_that_does_not_do_what_it_says_is_run_whole(tmp_path, version):
    """A function that fails is told with what the FMU has logged."""
    same, told = both(ForeignSimulator(made(tmp_path / "it", version, "REFUSES")), TWO)
    assert same == [True] * 2
    assert len(told) == 1
    assert f"fmi{version}SerializeFMU{'S' if version == 3 else 's'}tate gave error" in told[0]
    assert "[error] not in this edition" in told[0]


def test_one_that_ends_as_its_state_is_got_is_run_whole(tmp_path):
    """Its tests do not fail, and why they are run whole is told once."""
    same, told = both(ForeignSimulator(made(tmp_path / "it", 2, "CRASHES")), TWO)
    assert same == [True] * 2
    assert len(told) == 1
    assert "to put aside what it remembers has failed: " in told[0]
    assert "SIGABRT" in told[0]


def damaged(state):
    """The same bytes, one of them turned."""
    turned = bytearray(state)
    turned[len(turned) // 2] ^= 1
    return bytes(turned)


@pytest.fixture
def settled(stateful):
    """Give an FMU, what has its runs go on, and the state from which they do."""

    def settled(version):
        controller = ForeignSimulator(stateful(version))
        settles, told = settling(controller, SAGS)
        controller(SAGS[0], Parameters(), settles)
        assert told == []
        ((key, kept),) = settles._starts._kept.items()
        return controller, settles, key, kept

    return settled


@VERSIONS
@pytest.mark.parametrize(
    ("change", "reason"),
    [(damaged, "the state is damaged"), (lambda state: state[:-1], OTHER_SIZE), (lambda _: b"", OTHER_SIZE)],
    ids=["a bit", "shorter", "empty"],
)
def test_a_damaged_state_is_one_error(stateful, settled, version, change, reason):
    """The FMU's refusal is said with its function, and the whole run stands for the test."""
    controller, settles, key, kept = settled(version)
    resting = unpacked(kept.state)
    bad = resting._replace(controller=resting.controller._replace(state=change(resting.controller.state)))
    door = FmuDoor(stateful(version), {})
    with pytest.raises(DoorError, match=rf"^fmi{version}De[sS]erializeFMU[sS]tate gave error\n  \[error\] {reason}$"):
        door.resume(Nominal(), bad.controller)
    door.close()
    settles._starts._kept[key] = SettledController(bad.packed(), kept.samples, kept.start)
    assert are_the_same(controller(SAGS[1], Parameters(), settles), controller(SAGS[1], Parameters()))


@VERSIONS
def test_one_that_has_failed_is_not_asked(stateful, version):
    """By the standard it is not: here it would end this process, were it told to end after that."""
    door = FmuDoor(stateful(version), {})
    opened = door.open(Nominal())
    step = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(opened.address)
    assert step(None) == 0
    assert door.snapshot().steps == 1
    door._opened().steps += 1
    assert step(None) == 1
    failed = f"fmi{version}DoStep gave error"
    with pytest.raises(DoorError, match=f"GetFMU[sS]tate may not be called any more: {failed}"):
        door.snapshot()
    assert failed in door.message()
    door.close()


def test_a_state_of_another_controller_is_refused(stateful):
    """What another door has given is none of an FMU's."""
    door = FmuDoor(stateful(2), {})
    with pytest.raises(DoorError, match="the snapshot is of another controller"):
        door.resume(Nominal(), b"nothing")
    with pytest.raises(DoorError, match="not open"):
        door.snapshot()
