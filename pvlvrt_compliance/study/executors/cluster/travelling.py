"""How a user's own controller comes to a worker: as its files, or because the same is there already."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import is_there
from pvlvrt_compliance.study.job import Job

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.description import Description, Value
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

_FOLDER = "controller"
_PYTHON = ".py"


class Travelling(NamedTuple):
    """A controller on its way.

    Parameters
    ----------
    spec, mapping : str
        As the user has named it, and its mapping file.
    given : mapping
        Its parameters, as far as they are set.
    allow_out_of_range : bool
        Whether they may be out of the ranges that it states.
    digest : str
        That it must have there.
    beside : str
        Folder that names start from here: where else it may be, on a worker that has the same disk.
    sent_spec, sent_mapping : str
        Where it is in the worker's folder; empty where it cannot be sent, or lies beside it as it does here.
    why_not : str
        Why that is so.
    files : mapping
        Its files, by their places in the worker's folder.
    """

    spec: str
    mapping: str | None
    given: "Mapping[str, Value]"
    allow_out_of_range: bool
    digest: str
    beside: str
    sent_spec: str = ""
    sent_mapping: str = ""
    why_not: str = ""
    files: Mapping[str, Path] = {}


def travelling(controller: "ForeignSimulator", job: Job) -> Travelling:
    """How the opened controller of a job travels.

    Raises
    ------
    UsageError
        When it can be on no other machine.
    """
    if controller.stays_here:
        raise UsageError(f"controller {controller.spec} cannot be sent to other machines: {controller.stays_here}")
    own = Travelling(
        spec=controller.spec,
        mapping=job.mapping,
        given=job.given,
        allow_out_of_range=job.allow_out_of_range,
        digest=controller.description.digest,
        beside=str(Path.cwd()),
    )
    return _sent(own, controller.description)


def _sent(own: Travelling, description: "Description") -> Travelling:
    """The same with its files, if it consists of files that are known."""
    name, colon, rest = own.spec.rpartition(":")
    file, rest = (name, colon + rest) if Path(name).suffix == _PYTHON else (own.spec, "")
    listed = _listed(description.mapping)
    own_mapping = (description.mapping,) if description.mapping else ()
    if not is_there(Path(file)):
        return own._replace(why_not=description.besides)
    if description.besides and Path(file).suffix != _PYTHON and not (listed and description.may_be_listed):
        said = "list all that it is made of in its mapping (files = [...])" * description.may_be_listed
        return own._replace(why_not="; ".join(filter(None, (description.besides, said))))
    paths = [_placed(Path(path)) for path in (file, *own_mapping, *listed)]
    try:
        root = Path(os.path.commonpath([path.parent for path in paths]))
    except ValueError:
        return own._replace(why_not="its files are on several drives")
    places = {path: f"{_FOLDER}/{path.relative_to(root).as_posix()}" for path in paths}
    return own._replace(
        sent_spec=places[paths[0]] + rest,
        sent_mapping=places[paths[1]] if own.mapping else "",
        files={place: path for path, place in places.items()},
    )


def _placed(path: Path) -> Path:
    """A file by its folder's true place, and its own name: a link keeps that."""
    return path.parent.resolve() / path.name


def _listed(mapping: str | None) -> tuple[Path, ...]:
    from pvlvrt_compliance.controllers.mapping.file import load_mapping

    read = load_mapping(mapping)
    return read.listed if read is not None else ()
