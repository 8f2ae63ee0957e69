"""What happens to the frequency in tests of checks."""

from typing import Any


def ramp(to_hz: float, rate_hz_s: float = 1.0, t_s: float = 0.0, from_hz: float = 50.0) -> dict[str, Any]:
    """Ramp of the frequency to a level."""
    lasts_s = abs(to_hz - from_hz) / rate_hz_s
    return {
        "kind": "frequency_ramp",
        "t_s": t_s,
        "rate_hz_s": rate_hz_s if to_hz > from_hz else -rate_hz_s,
        "duration_s": lasts_s,
    }
