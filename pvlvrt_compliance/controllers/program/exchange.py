"""What goes to and fro between the loop and a program in each sample."""

import struct
from collections.abc import Callable, Sequence
from typing import Any

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.ties import RawPort
from pvlvrt_compliance.controllers.program.hello import as_line, shown, table_in
from pvlvrt_compliance.controllers.program.link import Conversation

HEAD = 8  # bytes before the numbers of a block: the last four are the length of its frame


def binary_exchange(talk: Conversation, inputs: memoryview, outputs: memoryview) -> Callable[[], None]:
    """Exchange of frames: a length of four bytes, then float64, both little-endian."""
    begin = HEAD - 4
    struct.pack_into("<I", inputs, begin, len(inputs) - HEAD)
    expected = struct.pack("<I", len(outputs) - HEAD)
    request, numbers = inputs[begin:], outputs[HEAD:]
    size, tell, frame = len(numbers), talk.tell, talk.frame

    def exchange() -> None:
        tell(request)
        numbers[:] = frame(expected, size)

    return exchange


def json_exchange(
    talk: Conversation, inputs: Sequence[RawPort], outputs: Sequence[RawPort], given: Any, taken: Any
) -> Callable[[], None]:
    """Exchange of lines of JSON."""
    template = "{" + ", ".join(f"{_word(p.name)}: {_places(p.width)}" for p in inputs) + "}\n"
    places = [(p.name, (p.byte - HEAD) // 8, p.width) for p in outputs]
    tell, line = talk.tell, talk.line

    def exchange() -> None:
        tell((template % tuple(given)).encode())
        reply = table_in(answer := line())
        try:
            for name, place, width in places:
                if width == 1:
                    taken[place] = reply[name]
                else:
                    _take(reply[name], taken, place, width)
        except (TypeError, ValueError, KeyError) as error:
            raise DoorError(f"the program answered {shown(answer)}: {_what(error)}") from None

    return exchange


def _take(values: Any, taken: Any, place: int, width: int) -> None:
    if not isinstance(values, list) or len(values) != width:
        raise ValueError(f"a list of {width} numbers is due")
    for k, value in enumerate(values):
        taken[place + k] = value


def _what(error: Exception) -> str:
    if isinstance(error, KeyError):
        return f"there is no {error.args[0]!r}"
    return "a number is due" if isinstance(error, TypeError) else str(error)


def _word(name: str) -> str:
    """Name in JSON, for a template of Python."""
    return as_line({name: 0}).decode()[1:].rpartition(":")[0].replace("%", "%%")


def _places(width: int) -> str:
    return "%r" if width == 1 else "[" + ", ".join(["%r"] * width) + "]"
