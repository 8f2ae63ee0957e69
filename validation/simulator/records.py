"""Simulated records, also of sags that no name describes, with relays that stay out of the way."""

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.space_vectors import clarke
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Segment

A = TypeVar("A")
B = TypeVar("B")

NOMINAL = Nominal()

NO_TRIPS: dict[str, Any] = {
    "overcurrent_pu": 1e3,
    "dc_overvoltage_v": 1e5,
    "undervoltage_curve": ((0.0, 0.0),),
    "frequency_delay_s": 1e3,
}
"""Settings of relays that never act."""


class ResidualSag(Sag):
    """A sag given by its three residual phasors (pu)."""

    residuals: tuple[complex, complex, complex]

    def phasors_pu(self) -> tuple[complex, complex, complex]:
        """Phase-to-neutral phasors a, b, c during the sag (pu)."""
        return self.residuals


def residual_sag(*residuals: complex) -> ResidualSag:
    """Sag with these residual phasors (pu)."""
    a, b, c = residuals
    return ResidualSag(depth=1.0, residuals=(a, b, c))


def without_trips(**groups: dict[str, Any]) -> Parameters:
    """Parameters, by group and name, with relays that never act."""
    protection = {**NO_TRIPS, **groups.pop("protection", {})}
    return Parameters.model_validate({**groups, "protection": protection})


def record(scenario: Scenario, parameters: Parameters | None = None) -> Segment:
    """Simulate a scenario; without parameters no relay acts."""
    return simulate(scenario, parameters or without_trips()).segments[0]


def vector(samples: Segment, kind: str) -> NDArray[np.complex128]:
    """Space vector of the voltages ``u`` or ``u0`` (V) or the currents ``i`` (A)."""
    ab: NDArray[np.complex128] = clarke(*samples.three_phase(kind))
    return ab


def rms(x: NDArray[Any]) -> float:
    """Root of the mean square of all values."""
    return float(np.sqrt(np.mean(np.abs(x) ** 2)))


def in_parallel(function: Callable[[A], B], items: Iterable[A]) -> list[B]:
    """Results in order; the compiled loop runs without the interpreter's lock, so threads help."""
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(function, items))
