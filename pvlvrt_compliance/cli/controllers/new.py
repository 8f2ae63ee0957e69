"""`pvlvrt-check controllers new`."""

from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.completion.asking import completer
from pvlvrt_compliance.cli.telling import say, say_aside
from pvlvrt_compliance.cli.writing import write_new
from pvlvrt_compliance.controllers.projects import KINDS, project
from pvlvrt_compliance.errors import UsageError, did_you_mean


def new(
    folder: Annotated[str, typer.Argument(metavar="DIR", help="Where to write it.", show_default=False)],
    kind: Annotated[
        str,
        typer.Option(
            metavar="KIND", help=f"{', '.join(KINDS[:-1])} or {KINDS[-1]}.", autocompletion=completer("project_kinds")
        ),
    ] = "python",
    install_from: Annotated[
        str | None,
        typer.Option(
            metavar="SPEC",
            help="Where the project takes this package from: pvlvrt-compliance==VERSION (of an index), a wheel, which"
            " is copied into it, or git+https://...@TAG. Without it a wheel that you put there.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Begin a controller: a small working project with a controller that rides through, and its gate in CI.

    Example: pvlvrt-check controllers new --kind c --install-from pvlvrt_compliance-0.2.0-py3-none-any.whl my-controller
    """
    if kind not in KINDS:
        raise UsageError(f"--kind {kind}: allowed are {', '.join(KINDS)}{did_you_mean(kind, KINDS)}")
    begun = project(kind, install_from)
    files = {Path(folder) / name: content for name, content in begun.files.items()}
    _refuse_existing(files)
    write_new(files, with_folders=True)
    for file in files:
        say(str(file))
    if begun.missing:
        missing = Path(folder) / begun.missing
        say_aside(f"Put {missing.name} into {missing.parent}, or CI cannot install it: README.md says how")
    if begun.pin:
        said = "names no single version, and a new one may change what the gate says: pin it"
        say_aside(f"--install-from {install_from}: {said}, as {begun.pin} does")


def _refuse_existing(files: dict[Path, bytes]) -> None:
    there = [str(file) for file in files if file.exists() or file.is_symlink()]
    if there:
        raise UsageError(f"there already, and left as they are: {', '.join(there)}; nothing was written")
