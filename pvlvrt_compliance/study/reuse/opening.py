"""Whether records are reused, of which controllers, and from where."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from pvlvrt_compliance.errors import UsageError, unwritable
from pvlvrt_compliance.study.settling import settling_simulator
from pvlvrt_compliance.trust import distrust
from pvlvrt_compliance.units import DATA_SIZE, parse_quantity

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.job import Asked, Job, Spell
    from pvlvrt_compliance.study.run import Simulator

DEFAULT_SIZE = "10GB"
"""Room for the records of all profiles that ship, which take 7 GB, with something over (chosen)."""

_BYTES_PER_GB = 10**9
_MOST_GB = 1e6  # chosen: no folder of one machine has a petabyte


def limit_of(asked: "Asked", spell: "Spell") -> int:
    """How many bytes stored records may take.

    Raises
    ------
    UsageError
        When the size is none, or the folder is no folder or may be somebody else's.
    """
    if asked.reuse is None:
        if asked.reuse_size is not None:
            raise UsageError(f"{spell('reuse_size')} needs {spell('reuse')}")
    elif said := _problem_of(asked.reuse):
        raise UsageError(f"{spell('reuse')} {asked.reuse}: {said}")
    given = DEFAULT_SIZE if asked.reuse_size is None else str(asked.reuse_size)
    size = parse_quantity(given, spell("reuse_size"), DATA_SIZE)
    if not 0 < size <= _MOST_GB:
        raise UsageError(f"{spell('reuse_size')}: {asked.reuse_size} must be above zero and at most {_MOST_GB:g} GB")
    return round(size * _BYTES_PER_GB)


def _problem_of(folder: str) -> str:
    """Why a folder cannot hold records, in words; empty where it can."""
    path = Path(folder)
    if not folder:
        return "a folder is needed"
    try:
        if not path.exists():
            return ""
        if not path.is_dir():
            return "it is not a folder"
    except OSError as error:  # too long, or in a folder that cannot be entered
        return f"it cannot be used: {error.strerror}"
    said = distrust(path)
    return (
        f"it is not used: {said}, and verdicts would rest on what lies there; name a folder of your own" if said else ""
    )


def reuse_notes(job: "Job", controller: "ForeignSimulator | None") -> Iterator[str]:
    """Make the folder, and say what is to be known of the reuse before the first test.

    Raises
    ------
    UsageError
        When the folder cannot be made.
    """
    if job.reuse is None:
        return
    try:
        Path(job.reuse).mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        said = unwritable(f"{job.reuse}: records cannot be kept: {error.strerror or error}", error)
        if isinstance(said, UsageError):
            raise said from None
        yield str(said)  # for want of room: the run goes on
    if job.debug:
        return  # which is told
    if controller is not None and (why := _unknown(controller)):
        yield f"{controller.spec}: no records are reused: {why}"


def simulator_for(job: "Job", controller: "ForeignSimulator | None") -> "Simulator":
    """What makes the records of a job, or takes them from where earlier runs have stored them.

    Raises
    ------
    UsageError
        When the folder may be somebody else's by now, or on this machine.
    """
    simulator = settling_simulator(job, controller)
    if job.reuse is None or job.debug or (controller is not None and _unknown(controller)):
        return simulator
    if said := _problem_of(job.reuse):
        raise UsageError(f"{job.reuse}: {said}")
    from pvlvrt_compliance.study.reuse.simulator import ReusingSimulator
    from pvlvrt_compliance.study.reuse.store import RecordStore

    return ReusingSimulator(simulator, controller, RecordStore(Path(job.reuse), job.reuse_bytes, job.made_ns))


def _unknown(controller: "ForeignSimulator") -> str:
    """Why it is not known when a controller's record is that of before, and what to do; empty where it is."""
    it = controller.description
    if not it.besides or (it.may_be_listed and controller.lists_files()):
        return ""
    if not it.may_be_listed:
        return it.besides
    return (
        f"{it.besides}, so what a record depends on is not known; list all files that it is made of and reads in its"
        ' mapping, files = ["gains.csv", "lib/*.py"], to have them reused'
    )
