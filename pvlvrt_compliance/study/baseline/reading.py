"""A baseline from its file."""

import hashlib
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.data.text import UnreadableError, read_text
from pvlvrt_compliance.errors import UsageError, listed
from pvlvrt_compliance.ordinary_file import mode_of
from pvlvrt_compliance.study.baseline.entries import Baseline
from pvlvrt_compliance.study.baseline.text import HEAD, parsed


class BaselineFile(NamedTuple):
    """A file that was read: its name as it was given, and the digest of its text, whatever ends its lines."""

    name: str
    digest: str
    baseline: Baseline


def read_baseline(name: str, spelled: str = "--baseline") -> BaselineFile:
    """Read a baseline.

    Parameters
    ----------
    name : str
        Its path.
    spelled : str
        How whoever asks writes what names it.

    Raises
    ------
    UsageError
        When it cannot be read, or is none: every problem with its line, and what is allowed.
    """
    try:
        text = read_text(Path(name), "a baseline")
    except UnreadableError as error:
        place = name if error.line is None else f"{name}:{error.line}"
        begin = "" if mode_of(Path(name)) else f"; an empty one is a file with the line {HEAD!r}"
        raise UsageError(f"{spelled} {place}: {error}{begin}") from None
    baseline, problems = parsed(text, name)
    if problems:
        raise UsageError(listed(f"{spelled} {name}", problems))
    return BaselineFile(name, digest_of(text), baseline)


def digest_of(text: str) -> str:
    """SHA-256 of the text of a baseline."""
    return hashlib.sha256(text.encode()).hexdigest()
