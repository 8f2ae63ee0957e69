"""Projects that a controller of one's own begins with: the files of `templates`, by kind."""

from pathlib import Path

KINDS = ("python", "c", "fmu")
"""Kinds of projects, as ``pvlvrt-check controllers new --kind`` has them."""

_TEMPLATES = Path(__file__).with_name("templates")
_PLACES = {"ci.yml": ".github/workflows/compliance.yml"}  # of files that lie elsewhere in a project
_PYTHON_OF = {"fmu": ("controller.py",)}  # what a kind has from the project in Python


def project_files(kind: str) -> dict[str, bytes]:
    """Files of a project by their paths in it (POSIX); one in C has the header of its interface."""
    sources = [file for file in sorted((_TEMPLATES / kind).iterdir()) if file.is_file()]
    sources += [_TEMPLATES / "python" / name for name in _PYTHON_OF.get(kind, ())]
    files = {_PLACES.get(file.name, file.name): file.read_bytes() for file in sources}
    if kind == "c":
        from pvlvrt_compliance.controllers.library import HEADER

        files[HEADER.name] = HEADER.read_bytes()
    return files
