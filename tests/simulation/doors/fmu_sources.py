"""FMUs made for the tests."""

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent


def built(script: Path, folder: Path, package: str = "pythonfmu") -> Path:
    """FMU of the class in a script, by a builder in a process of its own: it imports the script and leaves traces."""
    folder.mkdir(exist_ok=True)
    code = f"import sys; sys.path[:] = {sys.path!r}; from {package}.__main__ import cli_main; cli_main()"
    arguments = ["build", "-f", str(script), "-d", str(folder)]
    found = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    (file,) = folder.glob("*.fmu")
    return file
