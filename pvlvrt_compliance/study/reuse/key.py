"""The key of a record: a digest of everything that decides it. Two simulations of one key give the same bytes."""

import hashlib
import json
import os
import platform
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

import pvlvrt_compliance
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.scenario.events import Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.waveforms.recording import files_of

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

ROOMS = (
    *("compiled", "control", "controllers", "data", "hardware", "plant", "scenario", "simulation", "waveforms"),
    "",
)
"""Folders of the package whose modules may decide a record, plain Python included; the last one is its root."""

_LIBRARIES = ("comtrade", "fmpy", "llvmlite", "numba", "numpy", "scipy")
"""Other packages that compute, or read what is computed with."""

_PLACES = {"events": {"__all__": {"file"}}}
"""Where recordings lie is no part of a scenario's key: what is in them is."""

_COMPILER, _WHERE_CODE_IS_KEPT = "NUMBA_", "NUMBA_CACHE_DIR"
_COMPILERS_FILE = ".numba_config.yaml"  # in the working folder, where the compiler looks for it


def key_of(scenario: Scenario, parameters: Parameters, controller: object, surroundings: object) -> str:
    """Key of a record (64 hexadecimal digits).

    Parameters
    ----------
    scenario : Scenario
        Whole, with what is in the recordings that it plays back.
    parameters : Parameters
        Whole, with which of them are given: some have another value for a controller from outside unless they are.
    controller : object
        What `controller_parts` gives.
    surroundings : object
        What `surroundings_digest` gives.
    """
    return digest_of(
        {
            "scenario": _told(scenario, exclude=_PLACES),
            "recordings": recordings_parts(scenario),
            "parameters": _told(parameters),
            "controller": controller,
            "surroundings": surroundings,
        }
    )


def digest_of(parts: object) -> str:
    """Digest of plain values (64 hexadecimal digits)."""
    text = json.dumps(parts, sort_keys=True, ensure_ascii=False)
    return hashlib.blake2b(text.encode("utf-8", "surrogatepass"), digest_size=32).hexdigest()


def recordings_parts(scenario: Scenario) -> list[tuple[str, str]]:
    """Kind and digest of every file of the recordings that a scenario plays back, in their order; not their places."""
    recorded = (Path(event.file) for event in scenario.events if isinstance(event, Recording))
    return [(file.suffix, _content(file)) for recording in recorded for file in files_of(recording)]


def controller_parts(controller: "ForeignSimulator | None") -> object:
    """What identifies a controller: its file, its parameters, its mapping, and the files that this lists.

    Raises
    ------
    UsageError
        When the mapping cannot be used any more.
    """
    if controller is None:
        return "bundled"
    it, mapping = controller.description, controller.mapping()
    listed = load_mapping(mapping)
    folder = Path(mapping).parent if mapping else Path()
    return {
        "spec": controller.spec,
        "kind": it.kind,
        "name": it.name,
        "digest": it.digest,
        "parameters": controller.parameter_values(),
        "given": controller.given,
        "sample_time_s": it.sample_time_s,
        "mapping": _content(Path(mapping)) if mapping else None,
        "files": {file.relative_to(folder).as_posix(): _content(file) for file in (listed.listed if listed else ())},
    }


@cache
def surroundings_digest() -> str:
    """Digest of `surroundings_parts`, as they were when this process first asked: what it has loaded stays that."""
    return digest_of(surroundings_parts())


def surroundings_parts() -> dict[str, Any]:
    """What is the same for every record of a process: the sources, what runs them, and where."""
    from pvlvrt_compliance.kernel import sources_of
    from pvlvrt_compliance.simulation.loop import run

    return {
        "version": pvlvrt_compliance.__version__,
        "sources": sources_parts(Path(pvlvrt_compliance.__file__).parent),
        "compiled": sources_of(run).key,  # of the loop, of versions, and of the processor
        "compiler": [compiler_parts(os.environ), _content(Path(_COMPILERS_FILE))],
        "libraries": dict(_versions(_LIBRARIES)),
        "system": [platform.system(), *platform.libc_ver(), platform.win32_ver()[1], platform.mac_ver()[0]],
    }


def sources_parts(package: Path) -> dict[str, str]:
    """Digests of the modules of `ROOMS`, by their places in the package."""
    rooms = [package / room for room in ROOMS]
    files = sorted(file for room in rooms for file in (room.rglob("*.py") if room != package else room.glob("*.py")))
    return {file.relative_to(package).as_posix(): _content(file) for file in files}


def compiler_parts(environment: Mapping[str, str]) -> dict[str, str]:
    """What tells the compiler how to compile; where its code is kept makes no difference."""
    return {
        name: value for name, value in environment.items() if name.startswith(_COMPILER) and name != _WHERE_CODE_IS_KEPT
    }


def _versions(names: Iterable[str]) -> Iterator[tuple[str, str | None]]:
    for name in names:
        try:
            yield name, version(name)
        except PackageNotFoundError:
            yield name, None


def _told(model: BaseModel, exclude: Any = None) -> list[dict[str, Any]]:
    """All values of a model, and those that were given."""
    whole, given = (model.model_dump(mode="json", exclude=exclude, exclude_unset=unset) for unset in (False, True))
    return [whole, given]


def _content(file: Path) -> str:
    """Digest of a file (hexadecimal); empty where it cannot be read, of which the simulation then says more."""
    try:
        return hashlib.blake2b(file.read_bytes(), digest_size=32).hexdigest()
    except OSError:
        return ""
