"""Looking after a copy of a process that runs a user's controller: what it takes, against what it may take.

The system's own limits (`rlimit`) hold for one process alone, and say nothing of why it has failed. So they are the
second fence here, further out; the first is a look at everything that the copy has started, several times a second.
"""
# mypy: disable-error-code="attr-defined"

import os
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.controllers.limits import FILES, FILES_MB, MB, MEMORY, OUTPUT, PROCESSES, TIME, Limits
from pvlvrt_compliance.controllers.process import family

STOPPED = "the controller has been stopped (SIGSTOP), or has stopped itself"
"""Why a copy is ended that would never go on."""

_STOPPED_S = 2.0
"""How long a process must be seen stopped: one that a scheduler has stopped with all others goes on with them."""

_EVERY_S = 0.05  # a look, at least
_SHARE = 0.05  # of the time that looking may take
_FILES_EVERY_S = 0.5
_FAR = 1.5  # times the limit, and as many bytes as follow: where the system's own is
_FAR_BYTES = 512 << 20


class Watch:
    """Looks at all that this process has started.

    Parameters
    ----------
    limits : Limits
    said : Path
        File that what is printed goes to.
    folder : Path
        Temporary folder of the run.
    spared : collection of str
        Names in it that are not the controller's.
    """

    def __init__(self, limits: Limits, said: Path, folder: Path, spared: frozenset[str]) -> None:
        self._limits, self._folder, self._spared = limits, folder, spared
        self._said = os.open(said, os.O_RDONLY)
        self._until = time.monotonic() + limits.time_s
        self._stopped_since: float | None = None
        self._files_at = 0.0

    def close(self) -> None:
        """Look no more."""
        os.close(self._said)

    def look(self) -> tuple[str, float]:
        """What limit has been reached, if any is, and when to look again (s)."""
        began = time.monotonic()
        why = self._reached(began)
        return why, max(_EVERY_S, (time.monotonic() - began) / _SHARE)

    def at_end(self, end: family.CopyEnd) -> str:
        """What limit a copy that has ended had reached after the last look, if any."""
        if end.why:
            return end.why
        if self._is_beyond_output():
            return OUTPUT
        return MEMORY if end.status < 0 and end.peak_bytes > self._limits.memory_mb * MB else ""

    def _reached(self, now: float) -> str:
        if now > self._until:
            return TIME
        if self._is_beyond_output():
            return OUTPUT
        if why := self._reached_by(self._living(family.tree(os.getpid())), now):
            return why
        if now < self._files_at:
            return ""
        self._files_at = now + _FILES_EVERY_S
        return self._reached_by_files()

    def _reached_by(self, processes: list[family.Seen], now: float) -> str:
        if len(processes) > self._limits.processes:
            return PROCESSES
        if self._is_beyond_memory(processes):
            return MEMORY
        return STOPPED if self._have_been_stopped(processes, now) else ""

    def _is_beyond_output(self) -> bool:
        return os.fstat(self._said).st_size > self._limits.output_mb * MB

    def _living(self, processes: list[family.Seen]) -> list[family.Seen]:
        """Those that have not ended; of those that have, what this process has inherited is let go."""
        for seen in processes[1:]:  # the first is the copy itself, whose end is seen by who has made it
            if seen.state == "Z" and seen.parent == os.getpid():
                family.bury(seen.process.pid)
        return [seen for seen in processes if seen.state != "Z"]

    def _is_beyond_memory(self, processes: list[family.Seen]) -> bool:
        limit = self._limits.memory_mb * MB
        if sum(seen.memory for seen in processes) <= limit:  # with what they share counted several times
            return False
        owned = [family.memory_of(seen.process.pid) for seen in processes]
        return sum(seen.memory if own is None else own for seen, own in zip(processes, owned, strict=True)) > limit

    def _have_been_stopped(self, processes: list[family.Seen], now: float) -> bool:
        if not any(seen.state == "T" for seen in processes):
            self._stopped_since = None
            return False
        self._stopped_since = now if self._stopped_since is None else self._stopped_since
        return now - self._stopped_since > _STOPPED_S

    def _reached_by_files(self) -> str:
        count = size = 0
        for entry in _files_in(self._folder):
            if entry.name in self._spared:
                continue
            count += 1
            with suppress(OSError):
                size += entry.stat(follow_symlinks=False).st_blocks * 512
            if count > self._limits.files:
                return FILES
        return FILES_MB if size > self._limits.files_mb * MB else ""


def _files_in(folder: Path) -> Iterator["os.DirEntry[str]"]:
    """Everything in a folder and the folders in it, as far as it can be read; no link is followed."""
    folders = [str(folder)]
    while folders:
        with suppress(OSError), os.scandir(folders.pop()) as entries:
            for entry in entries:
                yield entry
                if entry.is_dir(follow_symlinks=False):
                    folders.append(entry.path)


def fence(limits: Limits) -> None:
    """Have the system hold this process, and each that it starts, to what is well above its limits (POSIX).

    Of memory it is data that counts (RLIMIT_DATA), not addresses: Go, Java and JavaScript reserve many gigabytes of
    addresses that they never use.
    """
    with suppress(ImportError, OSError, ValueError):
        import resource

        memory = int(_FAR * limits.memory_mb * MB) + _FAR_BYTES + _data_of_this_process()
        _set_soft(resource.RLIMIT_DATA, memory)
        _set_soft(resource.RLIMIT_FSIZE, int(limits.files_mb * MB))


def open_fence() -> None:
    """Let this process write what is not the controller's again."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        for kind in (resource.RLIMIT_DATA, resource.RLIMIT_FSIZE):
            _set_soft(kind, resource.getrlimit(kind)[1])


def _set_soft(kind: int, value: int) -> None:
    import resource

    hard = resource.getrlimit(kind)[1]
    resource.setrlimit(kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))


def _data_of_this_process() -> int:
    """Data that it has already (bytes)."""
    for line in Path("/proc/self/status").read_text("ascii", "replace").splitlines():
        if line.startswith("VmData:"):
            return int(line.split()[1]) * 1024
    return 0
