"""What a door is: the contract between the loop and every kind of controller from outside."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar, NamedTuple, Protocol

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.door.blocks import Block
from pvlvrt_compliance.units import Nominal


class DoorError(UsageError):
    """A controller cannot be opened, or has stopped; the message is for its author."""


class DoorCall(NamedTuple):
    """An open door. Addresses are of functions ``int32_t f(void *argument)`` in this process that return 0 on success.

    A function that returns 1 has something to say: with a ``note_address``, that is called, and the run goes on.
    Memory and functions live until the door is closed; the door keeps them alive.
    """

    address: int  # advances the controller by one sample
    argument: int  # what it is called with
    inputs: Block  # written before every call
    outputs: Block  # read after it; held in between
    first_address: int = 0  # called once before all others, when the first inputs are there; 0: none
    hold_address: int = 0  # called before it as long as the controller does not act yet; 0: none
    note_address: int = 0  # called after a function has returned 1; 0: that is a failure
    in_volts: bool = False  # whether the outputs command voltages
    in_a_frame: bool = False  # whether they do so in a frame that turns
    every: int = 1  # samples from one run of its slow task to the next
    recorded: tuple[str, ...] = ()  # names of the further signals, by which they are recorded
    notes: Sequence[str] = ()  # what the controller has to say; grows as it runs


class Door(Protocol):
    """One kind of controller. Used in a process of its own: opened once, run once, closed.

    A folder of this room with a module ``door`` holds one, a class that is named there as ``DOOR``; `doors` finds it.

    Parameters
    ----------
    spec : str
        What stands after ``--controller``.
    given : mapping
        Parameters that the user has set.
    mapping : str, optional
        Mapping file.
    allow_out_of_range : bool
        Whether a parameter may be out of the range that the controller states for it.

    Raises
    ------
    DoorError
        When there is nothing to open, or what is given does not fit it.
    """

    written: ClassVar[str]
    """How a specification of it is written: ``FILE.fmu``."""

    schemes: ClassVar[tuple[str, ...]] = ()
    """How specifications of it begin, if by that they are known: ``stdio:``."""

    suffixes: ClassVar[tuple[str, ...]] = ()
    """How the names of its files end, if by that they are known: ``.fmu``."""

    bare: bool = False
    """Whether its ports are tied to nothing: each number of them is a signal of its own (`mapping.bare`). Set before it
    is described or opened."""

    keeps_faults: ClassVar[bool] = False
    """Whether it takes `faults.Faults` as a fourth argument, and goes on behind those that are kept as far as it can:
    it describes what it knows, and `open` raises the first fault that stands in its way."""

    def __init__(
        self, spec: str, given: Mapping[str, Value], mapping: str | None = None, *, allow_out_of_range: bool = False
    ) -> None: ...

    def describe(self) -> Description:
        """Name, ports, parameters and sample time, known before it is opened.

        Raises
        ------
        DoorError
            When a mapping file does not fit its ports.
        """

    def besides(self) -> str:
        """What decides what the controller does besides its file, parameters and mapping; empty: nothing does."""

    def may_be_listed(self) -> bool:
        """Whether that is made known by the files that a mapping lists."""

    def open(self, nominal: Nominal) -> DoorCall:
        """Make a controller at rest for an inverter of this rating, ready for its first sample.

        Raises
        ------
        DoorError
            When it refuses.
        """

    def snapshot(self) -> Any:
        """All that the open controller remembers between two samples, to be pickled: another one goes on from there.

        Raises
        ------
        DoorError
            When that cannot be had, with the reason.
        """
        raise DoorError("a controller of its kind does not give what it remembers")

    def resume(self, nominal: Nominal, snapshot: Any) -> DoorCall:
        """Make a controller, in this or another process, that goes on from a snapshot; in place of `open`.

        Raises
        ------
        DoorError
            When it refuses, or the snapshot is of another.
        """
        del nominal, snapshot
        raise DoorError("a controller of its kind does not go on from what another remembers")

    def message(self) -> str:
        """What the controller has said last, above all why it failed."""

    def close(self) -> None:
        """End the controller."""


def described(door: Door) -> Description:
    """All that is known of a controller before its first run.

    Raises
    ------
    DoorError
        As of `Door.describe`.
    """
    # A door that says nothing of it has the methods of the protocol, which give nothing.
    return replace(door.describe(), besides=door.besides() or "", may_be_listed=bool(door.may_be_listed()))
