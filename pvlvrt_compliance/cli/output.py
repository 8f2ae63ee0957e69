"""The output folder. A run is staged beside its reports and takes their place only when it is whole."""

import json
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.errors import UsageError

WAVEFORMS = "waveforms"
INTERRUPTED = "interrupted"
RESULTS = "results.json"


class OutputFolder:
    """Files of one run on their way into the output folder.

    Parameters
    ----------
    folder : str
        As the user named it; made when it does not exist.

    Raises
    ------
    UsageError
        When nothing can be written there.
    """

    def __init__(self, folder: str) -> None:
        if not folder:
            raise UsageError("--output: a folder is needed")
        self.folder = Path(folder)
        self._made = [place for place in (self.folder, *self.folder.parents) if not place.exists()]
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.staging = Path(tempfile.mkdtemp(prefix=".unfinished-", dir=self.folder))
            (self.staging / WAVEFORMS).mkdir()
        except OSError as error:
            self._remove_made()
            raise UsageError(f"--output {folder}: cannot be written ({error.strerror or error})") from None

    def write(self, name: str, content: str | bytes) -> None:
        """Stage one file."""
        data = content.encode() if isinstance(content, str) else content
        (self.staging / name).write_bytes(data)

    @property
    def waveforms(self) -> Path:
        """Where waveforms are staged."""
        return self.staging / WAVEFORMS

    def finish(self) -> None:
        """Put the staged run in the place of the one before: waveforms first, so that every report finds its own."""
        stale = _records_of(self.folder)
        self._move_all(self.folder)
        for record in stale - _records_of(self.folder):
            for file in (self.folder / WAVEFORMS).glob(f"{record}.*"):
                file.unlink(missing_ok=True)
        if (self.folder / INTERRUPTED / RESULTS).is_file():
            shutil.rmtree(self.folder / INTERRUPTED)

    def keep_interrupted(self) -> Path:
        """Keep what is finished of an interrupted run, beside the reports of the last whole one."""
        place = self.folder / INTERRUPTED
        if (place / RESULTS).is_file():
            shutil.rmtree(place)
        self._move_all(place)
        return place

    def _move_all(self, place: Path) -> None:
        """Move the staged files one by one; what others have put there stays."""
        (place / WAVEFORMS).mkdir(parents=True, exist_ok=True)
        staged = [*sorted(self.waveforms.iterdir()), *sorted(f for f in self.staging.iterdir() if f.is_file())]
        for file in staged:
            file.replace(place / file.relative_to(self.staging))
        shutil.rmtree(self.staging, ignore_errors=True)

    def discard(self) -> None:
        """Leave no trace of this run."""
        shutil.rmtree(self.staging, ignore_errors=True)
        self._remove_made()

    def _remove_made(self) -> None:
        """Remove the folders that were not there before, as far as they are empty."""
        with suppress(OSError):
            for place in self._made:
                place.rmdir()


def _records_of(folder: Path) -> set[str]:
    """Names of the waveforms that the results in a folder refer to; of none or unreadable results, nothing."""
    try:
        tests = json.loads((folder / RESULTS).read_bytes())["tests"]
        return {Path(test["waveforms"]).stem for test in tests if test.get("waveforms")}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return set()
