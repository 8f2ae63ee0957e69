"""What a report must carry to be made again: versions, digests, parameters, the command."""

import os
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from typing import Any

from pvlvrt_compliance import __version__
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.timing import FIXED_TIME
from pvlvrt_compliance.texts import shell_word

_LIBRARIES = ("numpy", "scipy", "numba", "pydantic", "plotly")


def created_at() -> datetime:
    """Time of the run, whole seconds, UTC; ``SOURCE_DATE_EPOCH`` fixes it for reproducible files.

    Raises
    ------
    UsageError
        When ``SOURCE_DATE_EPOCH`` is not a number of seconds.
    """
    text = os.environ.get(FIXED_TIME)
    if text is None:
        return datetime.now(UTC).replace(microsecond=0)
    try:
        return datetime.fromtimestamp(int(text), UTC)
    except (ValueError, OverflowError, OSError):
        raise UsageError(f"{FIXED_TIME}: {text!r} is not a number of seconds") from None


def provenance(
    profiles: Sequence[Profile],
    parameters: Parameters,
    command: Sequence[str] | str,
    created: datetime,
    controller: Mapping[str, Any] | None = None,
    files: Mapping[str, Any] | None = None,
    settings: Mapping[str, Any] | None = None,
    reuse: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Everything that decides the figures of a run, as `results.json` carries it.

    ``command`` is the words of a command line, or a text as it is. ``controller`` says what a controller of the user's
    own is; without, it is the bundled one. ``files`` says where in a repository its file is, and those of profiles.
    ``settings`` says what of all that was written down in a file or the environment, ``reuse`` how many records are of
    earlier runs.
    """
    return {
        "created": created.isoformat(),
        "command": command if isinstance(command, str) else " ".join(map(shell_word, command)),
        "profile": ", ".join(profile.id for profile in profiles),
        "profile_digest": ", ".join(profile.digest for profile in profiles),
        **(controller or bundled()),
        **({"files": files} if files else {}),
        "versions": versions(),
        "parameters": parameters.model_dump(mode="json"),
        **({"settings": settings} if settings else {}),
        **({"reuse": reuse} if reuse else {}),
    }


def provenance_of_record(profile: Profile, record: Mapping[str, Any], created: datetime) -> dict[str, Any]:
    """The same of a record that was judged as it was; ``record`` says which."""
    return {
        "created": created.isoformat(),
        "profile": profile.id,
        "profile_digest": profile.digest,
        **record,
        "versions": versions(),
    }


def versions() -> dict[str, str]:
    """Versions of all that decides the figures of a run, and what they look like."""
    return {
        "pvlvrt-compliance": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in _LIBRARIES},
    }


def bundled() -> dict[str, str]:
    """Name and digest of the bundled controller: of the files that it is made from, its plant and loop included.

    The first time all of these are loaded, a quarter of a second.
    """
    from pvlvrt_compliance.kernel import sources_of
    from pvlvrt_compliance.simulation.loop import run

    return {"controller": "bundled", "controller_digest": sources_of(run).digest}
