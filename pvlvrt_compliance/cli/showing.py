"""What the main command prints of a run: its results, or why it has ended early."""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from rich.console import Console

from pvlvrt_compliance.data.marks import CHOSEN
from pvlvrt_compliance.report import console
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import REPORT
from pvlvrt_compliance.texts import printable


def log(text: str) -> None:
    """Say on stderr why a run has ended early; in a file a line stays one line."""
    screen = Console(stderr=True, highlight=False, markup=False, emoji=False)
    with suppress(OSError):
        screen.print(printable(text), soft_wrap=not screen.is_terminal)


def show(results: Results, folder: Path, *, quiet: bool, own_controller: bool) -> None:
    """Print the results of a run, whose files are in a folder.

    Raises
    ------
    OSError
        When standard output cannot be written.
    """
    screen = Console(highlight=False, markup=False, emoji=False)  # a profile's texts are shown as they are
    if quiet:
        screen.print(console.summary_line(results), soft_wrap=True)
        return
    screen.print(console.render(results))
    if own_controller:
        screen.print(_rates(results.provenance), soft_wrap=not screen.is_terminal)
    for profile in results.profiles:
        _show_doubts(screen, profile.notes)
        if profile.left_out:
            left_out = f"Left out: {', '.join(profile.left_out)} of {profile.id} (long; --include-long runs them)"
            screen.print(left_out, soft_wrap=not screen.is_terminal)
    screen.print(f"Report: {folder / REPORT}", soft_wrap=True)


def _rates(origin: Mapping[str, Any]) -> str:
    """How a controller of the user's own was run."""
    sample_us, steps = 1e6 * origin["controller_sample_time_s"], origin["plant_steps_per_sample"]
    return (
        f"Controller: {origin['controller']} ({origin['controller_kind']}), called every {sample_us:g} us;"
        f" plant step {origin['plant_step_us']:g} us ({steps} in a sample time);"
        f" computation delay {origin['computation_delay_samples']}"
    )


def _show_doubts(screen: Console, notes: tuple[str, ...]) -> None:
    """Name what is not verified; what the project itself has chosen is only counted, the report lists it."""
    chosen = [note for note in notes if f": {CHOSEN} (" in note]
    for note in notes:
        if note not in chosen:
            # In a file a note stays one line; a terminal would cut it in the middle of a word.
            screen.print(f"Not verified: {note}", soft_wrap=not screen.is_terminal)
    if chosen:
        screen.print(f"Not verified: {len(chosen)} numbers that this project has chosen (the report lists them)")
