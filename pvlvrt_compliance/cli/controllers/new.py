"""`pvlvrt-check controllers new`."""

from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.writing import write_new
from pvlvrt_compliance.controllers.projects import KINDS, project_files
from pvlvrt_compliance.errors import UsageError, did_you_mean


def new(
    folder: Annotated[str, typer.Argument(metavar="DIR", help="Where to write it.", show_default=False)],
    kind: Annotated[str, typer.Option(metavar="KIND", help=f"{', '.join(KINDS[:-1])} or {KINDS[-1]}.")] = "python",
) -> None:
    """Begin a controller: a small working project with a controller that rides through, ready for a CI job.

    Example: pvlvrt-check controllers new --kind c my-controller
    """
    if kind not in KINDS:
        raise UsageError(f"--kind {kind}: allowed are {', '.join(KINDS)}{did_you_mean(kind, KINDS)}")
    files = {Path(folder) / name: content for name, content in project_files(kind).items()}
    _refuse_existing(files)
    write_new(files, with_folders=True)
    for file in files:
        print(file)


def _refuse_existing(files: dict[Path, bytes]) -> None:
    there = [str(file) for file in files if file.exists() or file.is_symlink()]
    if there:
        raise UsageError(f"there already, and left as they are: {', '.join(there)}; nothing was written")
