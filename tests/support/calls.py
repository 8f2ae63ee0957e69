"""Programs, called in an environment that does not lead back to this one."""

import os
import subprocess
from pathlib import Path

from waiting import PATIENCE_S


def call_program(*command: object, cwd: Path) -> "subprocess.CompletedProcess[str]":
    """Run a program in an environment that does not lead back to this one."""
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    return subprocess.run(
        list(map(str, command)), cwd=cwd, env=inherited, capture_output=True, text=True, check=False, timeout=PATIENCE_S
    )


def completed(*command: object, cwd: Path) -> "subprocess.CompletedProcess[str]":
    """Run one that must end well."""
    done = call_program(*command, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done
