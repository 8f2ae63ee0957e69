"""The command at a terminal."""

import contextlib
import os
import subprocess
import sys


def at_terminal(*arguments, cwd, **environment):
    """Exit status, and all that a terminal of 80 columns gets."""
    import pty  # Windows has none

    ours, theirs = pty.openpty()
    inherited = {name: value for name, value in os.environ.items() if name not in {"NO_COLOR", "FORCE_COLOR"}}
    settings = {"TERM": "xterm-256color", "COLUMNS": "80", "LINES": "40", **environment}
    process = subprocess.Popen(
        [sys.executable, "-m", "pvlvrt_compliance.cli.main", "--profile", "iec61400-21", *arguments],
        cwd=cwd,
        env=inherited | settings,
        stdin=subprocess.DEVNULL,
        stdout=theirs,
        stderr=theirs,
    )
    os.close(theirs)
    seen = b""
    with contextlib.suppress(OSError):  # Linux says so when the other end is closed
        while chunk := os.read(ours, 65536):
            seen += chunk
    os.close(ours)
    return process.wait(), seen.decode()
