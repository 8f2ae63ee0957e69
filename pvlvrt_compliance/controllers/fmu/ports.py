"""Where the inputs or outputs of an FMU lie for the loop."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.fmu.model import Variable
from pvlvrt_compliance.controllers.mapping.ties import RawPort
from pvlvrt_compliance.simulation.door.blocks import ITEM_SIZES, block_memory


class Ports(NamedTuple):
    """Variables of an FMU in a block, one after another, those of a type together."""

    variables: tuple[Variable, ...]
    raw: tuple[RawPort, ...]
    memory: NDArray[np.uint8]


def laid_out(variables: Sequence[Variable]) -> Ports:
    """Give variables, the largest types first, their places in a block."""
    raw, byte = [], 0
    for v in variables:
        raw.append(RawPort(v.name, v.unit, v.width, byte, v.type.kind, v.description))
        byte += v.width * ITEM_SIZES[v.type.kind]
    return Ports(tuple(variables), tuple(raw), block_memory(byte))
