"""Whether two records are the same to the bit."""

from pvlvrt_compliance.waveforms import Waveforms


def are_the_same(a: Waveforms, b: Waveforms) -> bool:
    """Whether they have the same segments, of the same channels with the same bits, and the same trip."""
    return _bits(a) == _bits(b)


def _bits(record: Waveforms) -> object:
    segments = [
        (segment.t0_s, segment.dt_s, {name: x.tobytes() for name, x in segment.channels.items()})
        for segment in (*record.settling, *record.segments)
    ]
    return segments, record.tripped_at_s
