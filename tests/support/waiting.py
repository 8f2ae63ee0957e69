"""Waiting for what is to be seen; no test waits for a time."""

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters

PATIENCE_S = 500.0
"""What has not come by then will not come any more, on any machine (s)."""


def wait_until(seen: Callable[[], bool], what: str) -> None:
    """Wait until something is seen.

    Raises
    ------
    AssertionError
        With what it was, when it does not come.
    """
    given_up = time.monotonic() + PATIENCE_S
    while not seen():
        assert time.monotonic() < given_up, f"still waiting for {what}"
        time.sleep(0.02)


def doubled(limit_s: float) -> Iterator[float]:
    """Limits (s), each twice the last, for what must be seen before a limit acts, however busy the machine is.

    Raises
    ------
    AssertionError
        When another is asked for after `PATIENCE_S`.
    """
    while limit_s < PATIENCE_S:
        yield limit_s
        limit_s *= 2
    raise AssertionError(f"not even within {limit_s / 2:g} s")


def stopped_in_its_loop(
    simulator: Callable[[Scenario, Parameters], Any], scenario: Scenario, parameters: Parameters, sign: str
) -> str:
    """Error of a run that is stopped at its time limit once it has come to the endless loop, which its message shows.

    Every attempt must end by its limit; one that has not come so far is given twice the time.
    """
    for limit_s in doubled(2.0):
        simulation = parameters.simulation.model_copy(update={"time_limit_s": limit_s})
        with pytest.raises(SimulationError) as error:
            simulator(scenario, parameters.model_copy(update={"simulation": simulation}))
        assert f"stopped after {limit_s:g} s of computing (simulation.time_limit_s)" in str(error.value)
        if sign in str(error.value):
            break
    return str(error.value)
