"""Lines on stderr."""

import sys
from contextlib import suppress

from pvlvrt_compliance.texts import printable


def tell(message: str) -> None:
    """Say something to whoever reads stderr; that nobody does changes nothing."""
    with suppress(OSError):
        print(f"pvlvrt-check: {printable(message)}", file=sys.stderr)
