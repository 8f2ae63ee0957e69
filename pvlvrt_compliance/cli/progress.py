"""How far a run is, on stderr."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn


@contextmanager
def progress_bar(tests: int, quiet: bool) -> Iterator[Callable[[str, int, int], None]]:
    """Bar on stderr in a terminal; elsewhere silent. Calls name the test that begins and how many are done."""
    log = Console(stderr=True)
    if quiet or not log.is_terminal:
        yield _silent  # a bar that is switched off still ends a line, with rich before 14.3
        return
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=log, transient=True) as progress:
        task = progress.add_task("preparing the simulator (once after an update: about 15 s)", total=tests)
        begun = False

        def advance(test: str, done: int, _total: int) -> None:
            nonlocal begun
            if begun:
                progress.update(task, description=test, completed=done)
            begun = True

        yield advance


def _silent(_test: str, _done: int, _total: int) -> None:
    """Nothing is told."""
