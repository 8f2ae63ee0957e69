"""Numbers of the mapping file, written into a block once, before the first sample."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.simulation.door.blocks import ITEM_SIZES, NUMBER_TYPES


class Constant(NamedTuple):
    """A number, and where it stands in its block."""

    byte: int
    kind: int  # code of its type
    value: float  # units of the port


def set_constants(memory: NDArray[np.uint8], constants: Iterable[Constant]) -> None:
    """Write constants into a block's memory; whole numbers are rounded, and stay in the range of their type."""
    for constant in constants:
        kind: Any = NUMBER_TYPES[constant.kind]
        place = memory[constant.byte : constant.byte + ITEM_SIZES[constant.kind]].view(kind)
        if np.issubdtype(kind, np.floating):
            place[0] = constant.value
        else:
            limits = np.iinfo(kind)
            place[0] = round(min(max(constant.value, limits.min), limits.max))
