"""One file a format: its `FILE` in the folder of a run, and `render(results, drawings)`, text or bytes.

A file that is put here is written with every run, or where it has `ASKED_FOR = True`, only when its format is asked for
by its name; nothing else knows a format by name. That is the name of its module; `results_` before one that Python has
a module of, too, is no part of it. Besides, a module may have

- `needs()`, which says what is lacking (`UsageError`), before anything is run;
- `TAKES_A_WHILE = True`: whoever waits is told that it is written;
- `OF_WHOLE_RUNS = True`: a run that was interrupted does not wait for it, all others are written of its finished tests;
- `SHOWS`: the form in which it takes drawings, of `of_record.FORMS`; one that shows none is without it;
- `console(results)`: lines for standard output, which the command prints behind its own, where a program reads them;
  nothing where none does;
- `APPENDED_TO`: the environment variable with the name of a file that a CI service shows; the command appends the same
  there.
"""

import pkgutil
from collections.abc import Callable, Collection, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from pvlvrt_compliance.errors import UsageError, did_you_mean

if TYPE_CHECKING:  # help lists the names: it loads nothing that a format is made with
    from pvlvrt_compliance.results import Results

_PREFIX = "results_"


class Render(Protocol):
    """What makes a file from the results and from drawings, in the form that it `SHOWS`, by the key of their test."""

    def __call__(self, results: "Results", drawings: "Mapping[str, Any]", /) -> str | bytes:
        """The content of the file."""


class Format(NamedTuple):
    """A file of a run, and what makes it; the rest is as of the modules, none being empty."""

    name: str
    file: str
    render: Render
    asked_for: bool
    takes_a_while: bool
    of_whole_runs: bool
    shows: str
    needs: Callable[[], None]
    console: "Callable[[Results], str]"
    appended_to: str


def names() -> tuple[str, ...]:
    """Names of all formats, sorted; none of them is loaded."""
    return tuple(sorted(map(_name_of, _modules())))


def formats() -> tuple[Format, ...]:
    """All formats, by their names."""
    return tuple(sorted(map(_format, _modules())))


def chosen_formats(asked: Collection[str], spelled: str = "--format") -> tuple[Format, ...]:
    """Formats that are always written, and those that are asked for by name.

    Raises
    ------
    UsageError
        When there is no format of a name, or it lacks something that is not installed.
    """
    known = names()
    for name in asked:
        if name not in known:
            hint = did_you_mean(name, known)
            raise UsageError(f"{spelled}: no format {name!r}{hint}; there are: {', '.join(known)}")
    chosen = tuple(found for found in formats() if found.name in asked or not found.asked_for)
    for found in chosen:
        found.needs()
    return chosen


def of_made(found: Format, results: "Results", made: "Mapping[str, Mapping[str, Any]]") -> str | bytes:
    """The content of a file, of what has been made of every record for all formats (`of_record.made`)."""
    return found.render(results, {key: forms[found.shows] for key, forms in made.items() if found.shows in forms})


def _modules() -> list[str]:
    return [module.name for module in pkgutil.iter_modules(__path__)]


def _name_of(module: str) -> str:
    return module.removeprefix(_PREFIX)


def _format(name: str) -> Format:
    module = import_module(f"{__name__}.{name}")
    return Format(
        name=_name_of(name),
        file=module.FILE,
        render=module.render,
        asked_for=getattr(module, "ASKED_FOR", False),
        takes_a_while=getattr(module, "TAKES_A_WHILE", False),
        of_whole_runs=getattr(module, "OF_WHOLE_RUNS", False),
        shows=getattr(module, "SHOWS", ""),
        needs=getattr(module, "needs", _nothing),
        console=getattr(module, "console", _nothing_said),
        appended_to=getattr(module, "APPENDED_TO", ""),
    )


def _nothing() -> None:
    """A format that needs nothing besides the core."""


def _nothing_said(_results: "Results") -> str:
    """A format that is a file alone."""
    return ""
