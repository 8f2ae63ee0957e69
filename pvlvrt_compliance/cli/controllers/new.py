"""`pvlvrt-check controllers new`."""

from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.writing import write_new
from pvlvrt_compliance.errors import UsageError, did_you_mean

KINDS = ("python", "c", "fmu")

_PLACES = {"ci.yml": ".github/workflows/compliance.yml"}  # of files that lie elsewhere in a project
_PYTHON_OF = {"fmu": ("controller.py",)}  # what a kind has from the project in Python


def new(
    folder: Annotated[str, typer.Argument(metavar="DIR", help="Where to write it.", show_default=False)],
    kind: Annotated[str, typer.Option(metavar="KIND", help=f"{', '.join(KINDS[:-1])} or {KINDS[-1]}.")] = "python",
) -> None:
    """Begin a controller: a small working project with a controller that rides through, ready for a CI job.

    Example: pvlvrt-check controllers new --kind c my-controller
    """
    if kind not in KINDS:
        raise UsageError(f"--kind {kind}: allowed are {', '.join(KINDS)}{did_you_mean(kind, KINDS)}")
    files = {Path(folder) / name: content for name, content in _content(kind).items()}
    _refuse_existing(files)
    write_new(files, with_folders=True)
    for file in files:
        print(file)


def _content(kind: str) -> dict[str, bytes]:
    """Files of a project by their names in it."""
    from pvlvrt_compliance.resources import resource_folder

    templates = resource_folder("templates") / "controllers"
    sources = [file for file in sorted((templates / kind).iterdir()) if file.is_file()]
    sources += [templates / "python" / name for name in _PYTHON_OF.get(kind, ())]
    files = {_PLACES.get(file.name, file.name): file.read_bytes() for file in sources}
    if kind == "c":
        from pvlvrt_compliance.cli.controllers.header import header_text

        files["ieee_cigre.h"] = header_text().encode()
    return files


def _refuse_existing(files: dict[Path, bytes]) -> None:
    there = [str(file) for file in files if file.exists() or file.is_symlink()]
    if there:
        raise UsageError(f"there already, and left as they are: {', '.join(there)}; nothing was written")
