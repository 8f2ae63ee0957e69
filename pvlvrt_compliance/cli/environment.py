"""What the environment says of the terminal, before rich and typer go by it."""

import os
import re

_SIZES = ("COLUMNS", "LINES", "TERMINAL_WIDTH", "JUPYTER_COLUMNS", "JUPYTER_LINES")
_A_SIZE = re.compile(r"[1-9][0-9]{0,3}", re.ASCII)


def forget_what_is_no_width() -> None:
    """Take away a width and a height that are none: rich makes a number of whatever has digits, typer of anything."""
    for name in _SIZES:
        if name in os.environ and not _A_SIZE.fullmatch(os.environ[name]):
            del os.environ[name]
