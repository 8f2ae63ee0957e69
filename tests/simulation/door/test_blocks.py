"""Memory that loop and controller share: where its numbers lie, as compiled code is told."""

import numpy as np
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.door import ports
from pvlvrt_compliance.simulation.door.blocks import (
    IN_A_FRAME,
    ITEM_SIZES,
    MODULATING,
    NUMBER_TYPES,
    VOLTAGES,
    Block,
    Element,
    block_memory,
    port_table,
    real_block,
)
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SWITCHES


def test_numbers_of_every_type_are_found(in_python):
    """What is written for a signal comes back for it, from wherever it lies, in its type and unit."""
    kinds = sorted(NUMBER_TYPES)
    elements = tuple(Element(k, 8 * k, kind, gain=2.0, offset=1.0) for k, kind in enumerate(kinds))
    table = port_table(Block(block_memory(8 * len(kinds)), elements[::-1]))
    assert table.signal.tolist() == list(range(len(kinds)))
    given, found = np.arange(1.0, 1.0 + len(kinds)), np.zeros(len(kinds))
    in_python(ports.gather)(given, table)
    in_python(ports.scatter)(table, found)
    assert found.tolist() == given.tolist()
    for k, kind in enumerate(kinds):
        number = table.memory.uint8[8 * k : 8 * k + ITEM_SIZES[kind]].view(NUMBER_TYPES[kind])[0]
        assert number == 2 * given[k] + 1


@pytest.mark.parametrize("kind", [kind for kind, size in ITEM_SIZES.items() if size > 1])
def test_a_number_between_two_places_is_refused(kind):
    """Compiled code reads whole places of a type only."""
    with pytest.raises(UsageError, match=f"at byte 1 is not aligned to {ITEM_SIZES[kind]} bytes"):
        port_table(Block(block_memory(16), (Element(0, 1, kind),)))


def test_a_block_that_ends_within_a_number_is_refused():
    """Every type must fit into all of it."""
    with pytest.raises(UsageError, match="12 bytes; it must be a multiple of 8"):
        port_table(Block(block_memory(16)[:12], ()))


def test_reals_one_after_another():
    """The simplest block has a number a signal, in the order that is asked for, all of them 0."""
    block = real_block([3, 1])
    assert [(e.signal, e.byte, e.gain, e.offset) for e in block.elements] == [(3, 0, 1.0, 0.0), (1, 8, 1.0, 0.0)]
    assert (block.memory.nbytes, block.memory.any()) == (16, False)
    assert block_memory(0).nbytes == 8


def test_commands_are_of_two_kinds_and_switches():
    """Three modulating signals, three voltages, the switches, voltages in a frame, and no other."""
    assert (len(MODULATING), len(VOLTAGES)) == (3, 3)
    assert (*MODULATING, *VOLTAGES, *SWITCHES, *IN_A_FRAME) == COMMANDS
