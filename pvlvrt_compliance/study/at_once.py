"""How many tests are run at once, and by whom: what is asked for, checked."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from pvlvrt_compliance.errors import UsageError

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Asked

AUTO = "auto"
"""As many tests at once as there are cores."""

MOST_JOBS = 1024
"""Tests that may be run at once: chosen, for each is a process of some 200 MB."""

LOCAL = "local"
"""In place of a scheduler's address: one of this machine, for as long as the run lasts."""


def jobs_of(asked: "Asked", spell: Callable[[str], str]) -> str | int | None:
    """How many tests are run at once, as of `Asked`; one, where the controller is debugged.

    Raises
    ------
    UsageError
        When it is no such number.
    """
    given = asked.jobs
    if given is None or given == AUTO:
        return 1 if asked.debug else given
    try:
        count = int(given)
    except ValueError:
        count = 0
    if not 1 <= count <= MOST_JOBS:
        raise UsageError(f"{spell('jobs')} {given}: give how many tests are run at once, 1 to {MOST_JOBS}, or {AUTO}")
    return 1 if asked.debug else count


def cluster_of(asked: "Asked", spell: Callable[[str], str]) -> str | None:
    """The scheduler whose workers run the tests, as of `Asked`.

    Raises
    ------
    UsageError
        When it does not go with what else is asked for.
    """
    if asked.cluster not in (None, LOCAL) and asked.jobs not in (None, AUTO):
        own = f"goes with {spell('cluster')} {LOCAL} only: a scheduler has the workers that it has"
        raise UsageError(f"{spell('jobs')} {own}")
    if asked.cluster not in (None, LOCAL) and asked.reuse is not None:
        raise UsageError(f"{spell('reuse')}: the folder is of this machine; it does not go with {spell('cluster')}")
    if asked.cluster is not None and asked.debug:
        own = "runs the controller in the process of the command; it does not go with"
        raise UsageError(f"{spell('debug')} {own} {spell('cluster')}")
    if asked.cluster is not None and not asked.cluster.strip():
        raise UsageError(f"{spell('cluster')}: give the address of a scheduler (tcp://HOST:8786), or {LOCAL}")
    return asked.cluster
