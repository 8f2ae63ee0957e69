"""What the main command prints of a run: its results, or why it has ended early."""

from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pvlvrt_compliance.cli.telling import screen
from pvlvrt_compliance.report import console, doubts
from pvlvrt_compliance.report.formats import chosen_formats
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import REPORT
from pvlvrt_compliance.texts import each_line, one_line, shell_word


def log(text: str) -> None:
    """Say on stderr why a run has ended early; in a file a line stays one line."""
    beside = screen(aside=True)
    with suppress(OSError):
        beside.print(each_line(text), soft_wrap=not beside.is_terminal)


def show(
    results: Results,
    folder: Path,
    formats: Collection[str] = (),
    *,
    quiet: bool,
    own_controller: bool,
    verbose: bool = False,
    exit_zero: bool = False,
) -> None:
    """Print the results of a run, whose files are in a folder; ``formats`` were asked for besides.

    Raises
    ------
    OSError
        When standard output cannot be written.
    """
    shown = screen()
    if quiet:
        shown.print(console.summary_line(results, exit_zero=exit_zero), soft_wrap=True)
        return
    if not shown.is_terminal:
        shown.width = max(shown.width, console.least_width(results))
    shown.print(console.render(results, exit_zero=exit_zero))
    if own_controller:
        shown.print(_rates(results.provenance), soft_wrap=not shown.is_terminal)
    for line in doubts.in_full(results) if verbose else filter(None, [doubts.in_short(results)]):
        # In a file a line stays one line; a terminal would cut it in the middle of a word.
        shown.print(line, soft_wrap=not shown.is_terminal)
    for profile in results.profiles:
        if profile.left_out:
            left_out = f"Left out: {', '.join(profile.left_out)} of {profile.id} (long; --include-long runs them)"
            shown.print(left_out, soft_wrap=not shown.is_terminal)
        if profile.not_run:
            not_run = f"Not run: {', '.join(profile.not_run)} of {profile.id} (the run ended before)"
            shown.print(not_run, soft_wrap=not shown.is_terminal)
    if results.baseline and (results.baseline.better or results.baseline.gone):
        words = ("pvlvrt-check", "baseline", "update", results.baseline.file, "--results", str(folder))
        shown.print(f"To update the baseline: {' '.join(map(shell_word, words))}", soft_wrap=True)
    shown.print(f"Report: {_files(folder, formats)}", soft_wrap=True)


def _rates(origin: Mapping[str, Any]) -> str:
    """How a controller of the user's own was run."""
    sample_us, steps = 1e6 * origin["controller_sample_time_s"], origin["plant_steps_per_sample"]
    return (
        f"Controller: {origin['controller']} ({origin['controller_kind']}), called every {sample_us:g} us;"
        f" plant step {origin['plant_step_us']:g} us ({steps} in a sample time);"
        f" computation delay {origin['computation_delay_samples']}"
    )


def _files(folder: Path, formats: Collection[str]) -> str:
    """The report that people read, and the files that were asked for besides."""
    asked = [each.file for each in chosen_formats(formats) if each.asked_for]
    return one_line(", ".join(str(folder / file) for file in (REPORT, *asked)), None)
