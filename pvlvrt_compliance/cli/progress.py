"""How far a run is, on stderr."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, SpinnerColumn, Task, TextColumn
from rich.text import Text

from pvlvrt_compliance.cli.telling import screen
from pvlvrt_compliance.texts import one_line

_QUIET_S = 2.0  # what is over by then needs no forecast
_WIDTH = 20  # of the bar, in columns: the name of a test and the forecast stand beside it
_TENTHS_S, _MINUTE_S, _HOUR_S = 9.95, 60.0, 3600.0


@contextmanager
def progress_bar(tests: int, quiet: bool) -> Iterator[Callable[[str, int, int], None]]:
    """Bar on stderr in a terminal; elsewhere silent. Calls name the test that begins and how many are done."""
    log = screen(aside=True)
    if quiet or not log.is_terminal:
        yield _silent  # a bar that is switched off still ends a line, with rich before 14.3
        return
    pace = _Pace()
    columns = (
        SpinnerColumn("line" if log.options.ascii_only else "dots"),
        TextColumn("{task.description}", markup=False),
        BarColumn(_WIDTH),
        MofNCompleteColumn(),
        pace,
    )
    with Progress(*columns, console=log, transient=True) as progress:
        task = progress.add_task("preparing the simulator (once after an update: about 15 s)", total=tests)
        begun = False

        def advance(test: str, done: int, _total: int) -> None:
            nonlocal begun
            if begun:
                progress.update(task, description=one_line(test), completed=done)
            begun = True
            pace.begin()

        yield advance


class _Pace(ProgressColumn):
    """How many tests a second, and how long it will take from here, once that is worth saying."""

    def __init__(self) -> None:
        super().__init__()
        self._begun_s: float | None = None

    def begin(self) -> None:
        """Say that tests are run from now on."""
        self._begun_s = monotonic() if self._begun_s is None else self._begun_s

    def render(self, task: Task) -> Text:
        """The words for the bar."""
        elapsed_s = 0.0 if self._begun_s is None else monotonic() - self._begun_s
        return Text(pace_in_words(task.completed, task.total or 0, elapsed_s), style="progress.remaining")


def pace_in_words(done: float, total: float, elapsed_s: float) -> str:
    """The pace of a run and the time that is left by it; nothing while there is no telling, or no need to.

    Parameters
    ----------
    done, total : float
        Tests.
    elapsed_s : float
        Time since the first began (s).
    """
    if not done or elapsed_s < _QUIET_S:
        return ""
    each_s = elapsed_s / done
    pace = f"{1 / each_s:.2g} tests/s" if each_s < 1 else f"{_rough(each_s)} a test"
    return f"{pace}, {_rough(max(total - done, 0) * each_s)} left"


def _rough(time_s: float) -> str:
    """A time, as roughly as it can be told."""
    if time_s < _TENTHS_S:
        return f"{time_s:.1f} s"
    if time_s < 1.5 * _MINUTE_S:
        return f"{time_s:.0f} s"
    if time_s < 1.5 * _HOUR_S:
        return f"{time_s / _MINUTE_S:.0f} min"
    return f"{time_s / _HOUR_S:.1f} h"


def _silent(_test: str, _done: int, _total: int) -> None:
    """Nothing is told."""
