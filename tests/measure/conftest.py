from collections.abc import Callable

import numpy as np
import pytest

from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.waveforms import Segment

DT_S = 40.9568e-6
"""The control step of the reference plant: 488.28 samples a cycle at 50 Hz."""


@pytest.fixture(scope="session")
def dt_s() -> float:
    """A sampling step of which no cycle is a whole number."""
    return DT_S


@pytest.fixture(scope="session")
def sinusoid() -> Callable[..., np.ndarray]:
    """Samples of a phasor (peak value, angle at t = 0) turning at a frequency."""

    def sample(phasor: complex, frequency_hz: float, n: int, dt_s: float = DT_S) -> np.ndarray:
        return (phasor * np.exp(2j * np.pi * frequency_hz * dt_s * np.arange(n))).real

    return sample


@pytest.fixture(scope="session")
def three_phase(sinusoid) -> Callable[..., dict[str, np.ndarray]]:
    """Channels of a three-phase quantity by its sequence phasors and harmonics {order: (sequences)}."""

    def channels(kind, sequences, frequency_hz, n, harmonics=None, dt_s=DT_S) -> dict[str, np.ndarray]:
        parts = {1: sequences} | (harmonics or {})
        waves = [sum(sinusoid(phases(*parts[h])[k], h * frequency_hz, n, dt_s) for h in parts) for k in range(3)]
        unit = "a" if kind == "i" else "v"
        return {f"{kind}_{name}_{unit}": wave for name, wave in zip("abc", waves, strict=True)}

    return channels


@pytest.fixture(scope="session")
def segment() -> Callable[..., Segment]:
    """A segment that starts at 0 at the reference step."""

    def make(channels, dt_s=DT_S, t0_s=0.0) -> Segment:
        return Segment(t0_s, dt_s, channels)

    return make
