"""The files that this package consists of: which of them decide a record, which a result, and their digests."""

import hashlib
from collections.abc import Iterable
from pathlib import Path

import pvlvrt_compliance
from pvlvrt_compliance.resources import resource_folder

ROOMS = (
    *("compiled", "control", "controllers", "data", "hardware", "plant", "scenario", "simulation", "waveforms"),
    "",
)
"""Folders of the package whose modules may decide a record, plain Python included; the last one is its root."""


def of_records() -> dict[str, str]:
    """Digests of the modules of `ROOMS`, by their places in the package."""
    package = _package()
    rooms = (package / room for room in ROOMS)
    return _digests(package, (file for room in rooms for file in room.glob("*.py" if room == package else "**/*.py")))


def of_results() -> dict[str, str]:
    """Digests of all that decides what a test comes to, its part of a report among it: modules, templates, texts."""
    reports = resource_folder("reports")
    files = (file for file in reports.rglob("*") if file.is_file())
    templates = {f"reports/{place}": digest for place, digest in _digests(reports, files).items()}
    return _digests(_package(), _package().rglob("*.py")) | templates


def digest_of_file(file: Path) -> str:
    """Digest of a file (64 hexadecimal digits); empty where it cannot be read, of which whoever needs it says more."""
    try:
        return digest_of_content(file.read_bytes())
    except OSError:
        return ""


def digest_of_content(content: bytes) -> str:
    """Digest of bytes (64 hexadecimal digits)."""
    return hashlib.blake2b(content, digest_size=32).hexdigest()


def _package() -> Path:
    return Path(pvlvrt_compliance.__file__).parent


def _digests(folder: Path, files: Iterable[Path]) -> dict[str, str]:
    return {file.relative_to(folder).as_posix(): digest_of_file(file) for file in sorted(files)}
