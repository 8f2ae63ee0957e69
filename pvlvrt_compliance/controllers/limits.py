"""What the process of a user's controller may take, and the words for the limit that it has come to.

The one owner of these limits: their numbers are parameters (`simulation.parameters`), the table of them in
``docs/controllers/limits.md`` is held against `TABLE`, and whoever ends a process for one names it by `in_words`.
"""

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from pvlvrt_compliance.simulation.parameters import SimulationParameters

MB = 1_000_000
"""Bytes."""

_RUN_S, _RUN_PER_S = 60.0, 20.0  # of computing, and more of it for every second of the record


class Limits(NamedTuple):
    """What a process may take, with all that it starts."""

    time_s: float = 60.0  # of computing, by the clock (s)
    memory_mb: float = 2000.0
    output_mb: float = 64.0
    files_mb: float = 1000.0
    files: float = 10_000
    processes: float = 100
    opens: bool = True  # whether the controller is only opened, not run


class Limit(NamedTuple):
    """One of them: the parameter that sets it, and what has happened where it is reached."""

    parameter: str
    reached: str
    bound: str = ""


TIME, MEMORY, OUTPUT, FILES_MB, FILES, PROCESSES = "time_s", "memory_mb", "output_mb", "files_mb", "files", "processes"

TABLE: Mapping[str, Limit] = {
    TIME: Limit("simulation.time_limit_s", "the controller was stopped after {:g} s of computing"),
    MEMORY: Limit("simulation.memory_limit_mb", "the controller took more than {:g} MB of memory", "{:g} MB of memory"),
    OUTPUT: Limit("simulation.output_limit_mb", "the controller printed more than {:g} MB"),
    FILES_MB: Limit("simulation.files_limit_mb", "the controller has more than {:g} MB of files", "{:g} MB of files"),
    FILES: Limit("simulation.files_limit", "the controller has more than {:g} files"),
    PROCESSES: Limit("simulation.processes_limit", "the controller had more than {:g} processes at once"),
}
"""All limits, by their names in `Limits`."""

OPENING = Limit("simulation.opening_limit_s", TABLE[TIME].reached)
"""In place of the time of a run, where a controller is only opened."""

_SIGNS = {
    MEMORY: re.compile(
        r"MemoryError|bad_alloc|Cannot allocate memory|[Oo]ut of memory|[Ii]nsufficient memory|OutOfMemory"
    ),
    FILES_MB: re.compile(r"File too large|SIGXFSZ|signal 25\b"),
}
"""What libraries and systems say where a limit of this process is the reason."""


def limits_of_opening(simulation: SimulationParameters) -> Limits:
    """Limits of a controller that is only opened."""
    return _limits(simulation, simulation.opening_limit_s, opens=True)


def limits_of_run(simulation: SimulationParameters, record_s: float) -> Limits:
    """Limits of a run for a record of so many seconds."""
    return _limits(simulation, simulation.time_limit_s or _RUN_S + _RUN_PER_S * record_s, opens=False)


def _limits(simulation: SimulationParameters, time_s: float, *, opens: bool) -> Limits:
    return Limits(
        time_s=time_s,
        memory_mb=simulation.memory_limit_mb,
        output_mb=simulation.output_limit_mb,
        files_mb=simulation.files_limit_mb,
        files=simulation.files_limit,
        processes=simulation.processes_limit,
        opens=opens,
    )


def parameter_of(name: str, limits: Limits) -> str:
    """The parameter that sets a limit."""
    return (OPENING if name == TIME and limits.opens else TABLE[name]).parameter


def in_words(name: str, limits: Limits) -> str:
    """What has happened where a limit is reached: its value and its name."""
    value: Any = getattr(limits, name)
    return f"{TABLE[name].reached.format(value)} ({parameter_of(name, limits)})"


def allowing_more(parameter: str) -> str:
    """How a limit is raised."""
    return f"; --set {parameter}= allows more"


def with_limit_named(text: str, limits: Limits) -> str:
    """What a controller or its system says went wrong, with the limit by which it did, if it was one."""
    for name, sign in _SIGNS.items():
        limit = TABLE[name]
        if sign.search(text) and limit.parameter not in text:
            bound = limit.bound.format(getattr(limits, name))
            return f"{text}\nit may have {bound} ({limit.parameter}){allowing_more(limit.parameter)}"
    return text


class _Here:
    """Limits of the controller in this process."""

    limits = Limits()


def hold_to(limits: Limits) -> None:
    """Say what limits the controller in this process has."""
    _Here.limits = limits


def limits_here() -> Limits:
    """Limits of the controller in this process, for what is better refused than begun."""
    return _Here.limits
