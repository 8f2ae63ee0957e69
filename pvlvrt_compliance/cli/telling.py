"""What a command prints: whatever text of others is in it, nothing in it is obeyed by who reads it.

Nothing else of the package prints, but what rich makes of results (`screen`), which are of such texts already.
"""

import json
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.texts import all_printable, each_line, printable

if TYPE_CHECKING:
    from rich.console import Console


def tell(message: str) -> None:
    """Say something to whoever reads stderr; that nobody does changes nothing.

    Every line but the first is further in, so that no line of a text of others, a name that has two, passes for ours.
    """
    first, *more = message.split("\n")
    further = [line if line.startswith("  ") else f"  {line.strip()}" for line in more if line.strip()]
    say_aside("\n".join([f"pvlvrt-check: {first}", *further]))


def say_aside(message: str) -> None:
    """The same without our name before it."""
    with suppress(OSError):
        print(each_line(message), file=sys.stderr)


def say(text: str) -> None:
    """Print lines to standard output.

    Raises
    ------
    OSError
        When it cannot be written.
    """
    print("\n".join(map(printable, text.split("\n"))))


def hand_over(text: str) -> None:
    """Print a file of ours as it is, for a file or another program.

    Raises
    ------
    OSError
        When standard output cannot be written.
    """
    print(text, end="")


def say_json(data: Any, *, ensure_ascii: bool = True) -> None:
    """Print plain data for programs.

    Raises
    ------
    OSError
        When standard output cannot be written.
    """
    print(json.dumps(all_printable(data), indent=2, ensure_ascii=ensure_ascii))


def screen(*, aside: bool = False) -> "Console":
    """Where rich prints, standard output or aside; a text is shown as it is, and no markup in it is read."""
    from rich.console import Console

    return Console(stderr=aside, highlight=False, markup=False, emoji=False)
