"""Scenario files that people write."""

import tomllib
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.events import Event


class EventsFile(BaseModel):
    """A TOML file with a list of ``[[events]]``."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    events: tuple[Event, ...]


def load_events(path: str) -> tuple[Event, ...]:
    """Read events from a TOML file.

    Raises
    ------
    UsageError
        When the file cannot be read or an event cannot be used; all problems at once, each with its key.
    """
    try:
        table = tomllib.loads(Path(path).read_text("utf-8"))
        return EventsFile.model_validate(table).events
    except OSError as error:
        raise UsageError(f"{path}: cannot be read ({error.strerror})") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: not TOML ({error})") from None
    except ValidationError as error:
        problems = [f"  {_key(problem['loc'])}: {problem['msg']}" for problem in error.errors()]
        raise UsageError("\n".join([f"{path}: {len(problems)} problem(s)", *problems])) from None


def _key(location: tuple[int | str, ...]) -> str:
    return ".".join(f"[{part}]" if isinstance(part, int) else part for part in location).replace(".[", "[")
