"""Lines on stderr."""

import sys
from contextlib import suppress


def tell(message: str) -> None:
    """Say something to whoever reads stderr; that nobody does changes nothing."""
    with suppress(OSError):
        print(f"pvlvrt-check: {message}", file=sys.stderr)
