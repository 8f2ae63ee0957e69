"""When the breaker of a record opens."""

from pvlvrt_compliance.waveforms.container import Waveforms

CONNECTED = "connected"


def opened_at_s(waveforms: Waveforms) -> float | None:
    """First instant with the breaker open (s), by the channel ``connected``; None where there is none or no channel."""
    for segment in waveforms:
        closed = segment.channels.get(CONNECTED)
        if closed is not None and (closed < 0.5).any():
            return float(segment.t_s[(closed < 0.5).argmax()])
    return None
