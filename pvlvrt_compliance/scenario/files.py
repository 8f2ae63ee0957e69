"""Scenario files that people write."""

from pathlib import Path

from pydantic import BaseModel, ConfigDict

from pvlvrt_compliance.data.reader import Kind, Source, read_model
from pvlvrt_compliance.errors import UsageError, listed
from pvlvrt_compliance.scenario.events import Event, Events, recordings_named


class EventsFile(BaseModel):
    """A TOML file with a list of ``[[events]]``."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    events: Events


EVENTS = Kind("an events file", "events files", lambda origin, problems: UsageError(listed(origin, problems)))


def load_events(path: str) -> tuple[Event, ...]:
    """Read events from a TOML file; recordings lie in its folder or below, and paths of them count from there.

    Raises
    ------
    UsageError
        When the file cannot be read or an event cannot be used; all problems at once, each with its line and key.
    """
    source = Source(Path(path), EVENTS)
    events = read_model(source, EventsFile).events
    return recordings_named(events, source.path.parent, lambda index: source.problem(("events", index, "file"), ""))
