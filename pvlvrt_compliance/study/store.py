"""The output folder. A run is staged beside its reports and takes their place only when it is whole.

One run at a time: a lock file stands in the folder meanwhile. The next run finishes what a killed one has begun to put
in place, and clears away what it has only staged.
"""

import json
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pvlvrt_compliance.errors import OutputError, UsageError, unwritable
from pvlvrt_compliance.locks import Lock, holder_of, take_lock
from pvlvrt_compliance.results.files import INTERRUPTED, JUNIT, ON_REQUEST, REPORT, RESULTS, WAVEFORMS
from pvlvrt_compliance.study.placing import Placing, begun_in, in_order, remove, remove_empty

_VERDICTS = (*ON_REQUEST, REPORT, JUNIT, RESULTS)  # results.json comes last and goes first: where it is, everything is
_STAGING, _LOCK = ".unfinished-", ".unfinished.lock"
_EMPTY_LIST = b"[]"
_RECORD_ENDINGS = (".cfg", ".dat", ".csv")


@contextmanager
def writing(path: Path, staging: Path, folder: Path) -> Iterator[None]:
    """Say of a staged file that cannot be written where in the folder it was to go.

    Raises
    ------
    OutputError
        In place of an OSError.
    """
    try:
        yield
    except OSError as error:
        place = folder / path.relative_to(staging)
        raise OutputError(f"{place} cannot be written: {error.strerror or error}") from error


class OutputFolder:
    """Files of one run on their way into the output folder.

    Parameters
    ----------
    folder : str
        As the user named it; made when it does not exist.
    spell : callable
        How whoever asks writes ``output``: a message names what he has typed.
    files : tuple of str
        Names of all files that may be written, in the order in which they take their places.

    Raises
    ------
    UsageError
        When nothing can be written there, or another run is writing there.
    OutputError
        When there is no room for a file.
    """

    def __init__(self, folder: str, spell: Callable[[str], str] = str, *, files: tuple[str, ...] = _VERDICTS) -> None:
        self._asked = spell("output")
        self._names = files
        if not folder:
            raise UsageError(f"{self._asked}: a folder is needed")
        self.folder = Path(folder)
        self.notes: list[str] = []  # what was found here and is worth telling
        self._made: list[Path] = []
        self.is_placed = False  # whether this run has taken its place
        self.is_stuck = False  # whether it can neither take its place nor leave it: the next run has to
        self._lock: Lock | None = None
        self.staging = Path()
        try:
            self._made = [place for place in (self.folder, *self.folder.parents) if not place.exists()]
            self._lock = self._taken()
            self._settle()
            self._refuse_obstacles()
            self.staging = Path(tempfile.mkdtemp(prefix=_STAGING, dir=self.folder))
            self.waveforms.mkdir()
        except OSError as error:
            self.discard()
            place = f" ({error.filename})" if error.filename and Path(error.filename) != self.folder else ""
            said = f"{self._asked} {folder}: cannot be written: {error.strerror or error}{place}"
            raise unwritable(said, error) from None
        except BaseException:
            self.discard()
            raise

    @property
    def waveforms(self) -> Path:
        """Where waveforms are staged."""
        return self.staging / WAVEFORMS

    def write(self, name: str, content: str | bytes) -> None:
        """Stage one file.

        Raises
        ------
        OutputError
            When it cannot be written.
        """
        data = content.encode("utf-8", "backslashreplace") if isinstance(content, str) else content
        with writing(self.staging / name, self.staging, self.folder):
            (self.staging / name).write_bytes(data)

    def write_if_possible(self, name: str, content: str | bytes) -> None:
        """Stage one file whole, or not at all."""
        try:
            self.write(name, content)
        except OutputError:
            (self.staging / name).unlink(missing_ok=True)

    def finish(self) -> None:
        """Put the staged run in the place of the one before, of which nothing stays, nor of an interrupted one.

        Raises
        ------
        OutputError
            When that cannot be done; what was there is back in its place, else the message says so.
        """
        self._put("", (*self._files_of(""), *self._files_of(INTERRUPTED)))
        remove_empty([self.folder / INTERRUPTED / WAVEFORMS, self.folder / INTERRUPTED, self.folder / WAVEFORMS])
        self.discard()

    def keep_interrupted(self) -> Path:
        """Keep what is staged of an interrupted run, beside the reports of the last whole one.

        Raises
        ------
        OutputError
            As of `finish`.
        """
        self._put(INTERRUPTED, self._files_of(INTERRUPTED))
        self.discard()
        return self.folder / INTERRUPTED

    def drop_all_but(self, records: set[str]) -> None:
        """Remove what is staged, but for the files of these records: room for what is still to be written."""
        for file in self.staging.iterdir():
            if file.is_file():
                file.unlink()
        for file in self.waveforms.iterdir():
            if file.stem not in records:
                file.unlink()

    def discard(self) -> None:
        """Leave no trace of this run but what is in its place, or has to stay for the next one."""
        if self.staging.name and not self.is_stuck:
            remove(self.staging)
        self._let_go()

    def _put(self, into: str, replaced: tuple[str, ...]) -> None:
        staged = [path.relative_to(self.staging).as_posix() for path in self.staging.rglob("*") if path.is_file()]
        prefix = f"{into}/" if into else ""
        taken = {f"{prefix}{name}" for name in staged if (self.folder / into / name).is_file()}
        own = tuple(f"{prefix}{name}" for name in self._names)
        withdrawn = tuple(reversed(in_order(taken | set(replaced), own)))
        placing = Placing(self.staging, into, withdrawn, in_order(staged, self._names))
        begun = False
        try:
            placing.begin()
            begun = True
            placing.finish()
        except OSError as error:
            said = f"{error.filename or self.folder} cannot be written: {error.strerror or error}"
            raise OutputError(self._taken_back(placing, said)) from error
        except BaseException as end:  # an interruption: it is either in its place by now or has never been there
            self.is_placed = begun and not placing.is_open
            said = self._taken_back(placing, "stopped while files were put in place")
            if self.is_stuck:
                raise OutputError(said) from end
            raise
        self.is_placed = True

    def _taken_back(self, placing: Placing, said: str) -> str:
        """What is to be said of a run that could not be put in place, after what had moved has been put back."""
        self.is_stuck = placing.is_open  # until all is back: whatever happens meanwhile, what is aside is not removed
        try:
            if placing.is_open:
                placing.take_back()
        except OSError as again:
            return (
                f"{said}; nor could what was there be put back ({again.strerror or again}):"
                f" the next run into {self.folder} finishes this one from {placing.staging}"
            )
        self.is_stuck = False
        remove_empty([self.folder / placing.into / WAVEFORMS, *([self.folder / INTERRUPTED] if placing.into else [])])
        return said

    def _taken(self) -> Lock:
        self.folder.mkdir(parents=True, exist_ok=True)
        lock = take_lock(self.folder / _LOCK)
        if lock is None:
            holder = holder_of(self.folder / _LOCK)
            raise UsageError(
                f"{self._asked} {self.folder}: another run{f' (process {holder})' if holder else ''} is writing there;"
                " wait for its end, or name another folder"
            )
        if not lock.is_certain:
            self.notes.append(f"{self.folder}: its file system has no locks; a second run at once would not be noticed")
        return lock

    def _settle(self) -> None:
        """Finish what a killed run has begun to put in place, clear away what one has only staged."""
        for staging in sorted(self.folder.glob(f"{_STAGING}*")):
            if staging.is_symlink() or not staging.is_dir():
                continue
            if placing := begun_in(staging):
                placing.finish()
                remove(staging)
                self.notes.append(
                    f"{self.folder}: a run that was stopped while its files were put in place is whole now"
                )
            elif self._lock is not None and self._lock.is_certain:
                remove(staging)

    def _refuse_obstacles(self) -> None:
        """Refuse what would be in the way of the files when all is simulated.

        Raises
        ------
        OSError
            With the name of what is in the way.
        """
        for place in (self.folder / name for name in self._names):
            if place.is_dir():
                raise IsADirectoryError(0, "a folder is in the way", str(place))
        waveforms = self.folder / WAVEFORMS
        if waveforms.exists() and not (waveforms.is_dir() and os.access(waveforms, os.W_OK | os.X_OK)):
            raise PermissionError(0, "no files can be put there", str(waveforms))
        if waveforms.exists() and _device_of(waveforms) != _device_of(self.folder):
            raise OSError(0, "it is on another file system than the folder that it stands in", str(waveforms))

    def _files_of(self, part: str) -> tuple[str, ...]:
        """Files of the run in the folder, or in a folder in it, by their names in the folder; of nobody else."""
        root = self.folder / part
        results = _results_in(root)  # of a large run they are many megabytes: read once
        records = _records_of(results)
        prefix = f"{part}/" if part else ""
        verdicts = [name for name in self._names if (root / name).is_file() and (not part or records is not None)]
        verdicts = [name for name in verdicts if name not in ON_REQUEST or _is_of_the_run(root / name, results)]
        found = (root / WAVEFORMS).iterdir() if records else ()
        waveforms = [f.name for f in found if f.stem in (records or ()) and f.suffix in _RECORD_ENDINGS and f.is_file()]
        return (*(f"{prefix}{name}" for name in verdicts), *(f"{prefix}{WAVEFORMS}/{name}" for name in waveforms))

    def _let_go(self) -> None:
        """Release the lock, and remove the folders that were not there before, as far as they are empty."""
        lock, self._lock = self._lock, None
        if lock is not None:
            lock.release()
        remove_empty(self._made)


def _device_of(place: Path) -> int:
    return place.stat().st_dev


def _results_in(folder: Path) -> Any:
    """The results in a folder as they were written; None of no or unreadable ones, or of what is no ordinary file."""
    file = folder / RESULTS
    try:
        return json.loads(file.read_bytes()) if file.is_file() else None  # a pipe would be waited for
    except (OSError, ValueError, RecursionError):
        return None


def _is_of_the_run(report: Path, results: Any) -> bool:
    """Whether a file that only some runs write is of the results beside it: it carries their id, as is, or nothing."""
    try:
        run_id, content = results["run_id"], report.read_bytes()
        return content.strip() == _EMPTY_LIST or (bool(run_id) and str(run_id).encode() in content)
    except (OSError, KeyError, TypeError):
        return False


def _records_of(results: Any) -> set[str] | None:
    """Names of the waveforms that results refer to; None of no or unreadable results."""
    try:
        return {Path(test["waveforms"]).stem for test in results["tests"] if test.get("waveforms")}
    except (KeyError, TypeError, AttributeError):
        return None
