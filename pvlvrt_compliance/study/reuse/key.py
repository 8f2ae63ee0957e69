"""The key of a record: a digest of everything that decides it. Two simulations of one key give the same bytes."""

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
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, content_of
from pvlvrt_compliance.scenario.events import Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.sources import digest_of_content, digest_of_file, of_records
from pvlvrt_compliance.waveforms.recording import LARGEST_RECORD_BYTES, files_of

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

_LIBRARIES = ("fmpy", "llvmlite", "numba", "numpy", "scipy")
"""Other packages that compute."""

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
    return digest_of_content(text.encode("utf-8", "surrogatepass"))


def recordings_parts(scenario: Scenario) -> list[tuple[str, str]]:
    """Kind and digest of every file of the recordings that a scenario plays back, in their order; not their places."""
    recorded = (event.located()[0] for event in scenario.events if isinstance(event, Recording))
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
        "mapping": digest_of_file(Path(mapping)) if mapping else None,
        "files": {
            file.relative_to(folder).as_posix(): digest_of_file(file) for file in (listed.listed if listed else ())
        },
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
        "sources": of_records(),
        "compiled": sources_of(run).key,  # of the loop, of versions, and of the processor
        "compiler": [compiler_parts(os.environ), digest_of_file(Path(_COMPILERS_FILE))],
        "libraries": dict(_versions(_LIBRARIES)),
        "system": [platform.system(), *platform.libc_ver(), platform.win32_ver()[1], platform.mac_ver()[0]],
    }


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
        return digest_of_content(content_of(file, LARGEST_RECORD_BYTES))
    except NotOrdinaryError:
        return ""
