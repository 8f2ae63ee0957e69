"""Recordings that tests play back: each is found and read before anything is simulated."""

import stat
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import mode_of
from pvlvrt_compliance.scenario.events import Event, Recording
from pvlvrt_compliance.scenario.recordings import Named
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.selection import Assignment

if TYPE_CHECKING:
    from pvlvrt_compliance.study.from_asked import Spell


def with_recordings(
    tests: tuple[Assignment, ...], folder: str | None, spell: "Spell", *, are_read: bool = True
) -> tuple[Assignment, ...]:
    """Tests whose recordings are looked for in a folder of recordings, too, and are known to be such once read.

    Raises
    ------
    UsageError
        When the folder is none, or a recording cannot be used: with the file that names it, line and key.
    """
    if are_read and folder is not None and not stat.S_ISDIR(mode_of(Path(folder))):
        raise UsageError(f"{spell('recordings')} {folder}: it is not a folder")
    also = None if folder is None else Path(folder).absolute()
    found = tuple(_looked_for_in(item, also) for item in tests)
    if are_read:
        played = (
            (event, event.given_scale, item.test.scenario.nominal_frequency_hz)
            for item in found
            for event in recordings_of(item.test.scenario)
        )
        for event, _, frequency_hz in dict.fromkeys(played):
            _read(event, frequency_hz, spell)
    return found


def recordings_of(scenario: Scenario) -> Iterator[Recording]:
    """Recordings that a scenario plays back."""
    return (event for event in scenario.events if isinstance(event, Recording))


def _looked_for_in(item: Assignment, also: Path | None) -> Assignment:
    scenario = item.test.scenario
    if also is None or not any(recordings_of(scenario)):
        return item
    events = tuple(_looked_for(event, also) for event in scenario.events)
    scenario = scenario.model_copy(update={"events": events})
    return item._replace(test=item.test.model_copy(update={"scenario": scenario}))


def _looked_for(event: Event, also: Path) -> Event:
    if not isinstance(event, Recording):
        return event
    if event.named is None:  # any file, by its path from here; what is none may be in the folder
        return event if Path(event.file).exists() else event.named_by(Named((also,)))
    return event.named_by(event.named.also_in(also))


def _read(event: Recording, frequency_hz: float, spell: "Spell") -> None:
    from pvlvrt_compliance.waveforms.playback import read_voltages  # with numpy, which other jobs do not need here

    place = event.named.place if event.named is not None and event.named.place else f"{spell('events')}: "
    try:
        file, within = event.located()
        read_voltages(file, event.channels, event.given_scale, frequency_hz, within)
    except UsageError as error:
        raise UsageError(f"{place}{event.as_named(str(error))}") from None
