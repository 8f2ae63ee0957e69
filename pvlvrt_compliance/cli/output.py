"""The output folder. A run is staged beside its reports and takes their place only when it is whole."""

import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.errors import UsageError

WAVEFORMS = "waveforms"
INTERRUPTED = "interrupted"


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
        """Put the staged run in the place of the one before."""
        self._replace_folder(self.waveforms, self.folder / WAVEFORMS)
        for file in sorted(self.staging.iterdir()):
            if file.is_file():
                os.replace(file, self.folder / file.name)  # noqa: PTH105 - Path.replace is the same call
        shutil.rmtree(self.staging, ignore_errors=True)

    def keep_interrupted(self) -> Path:
        """Keep what is finished of an interrupted run, beside the reports of the last whole one."""
        place = self.folder / INTERRUPTED
        self._replace_folder(self.staging, place)
        return place

    def discard(self) -> None:
        """Leave no trace of this run."""
        shutil.rmtree(self.staging, ignore_errors=True)
        self._remove_made()

    def _remove_made(self) -> None:
        """Remove the folders that were not there before, as far as they are empty."""
        with suppress(OSError):
            for place in self._made:
                place.rmdir()

    def _replace_folder(self, new: Path, place: Path) -> None:
        if place.exists():
            shutil.rmtree(place)
        new.replace(place)
