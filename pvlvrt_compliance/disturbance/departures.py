"""The instant of a step, to the sample: a voltage of one cycle shows that there is one, and that up to a cycle late."""

import math

import numpy as np

from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms

_LEAST_PU = 0.01  # that a phase differs by from a cycle before (chosen): half of the smallest step that is looked for
_ABOVE_BEFORE = 3.0  # times what it differed by before, of noise or of another frequency (chosen)
_CYCLES_BEFORE = 4  # that this is looked for in (chosen): a sag of two cycles spoils three
_SOUGHT_CYCLES = 1.05  # before the instant: a step is seen within a cycle, and a sample or two


def departure_s(waveforms: Waveforms, kind: str, seen_s: float, cycle_s: float, peak_v: float) -> float:
    """When the voltages leave what they were a cycle before.

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    kind : str
        ``u`` or ``u0``.
    seen_s : float
        When a one-cycle voltage shows the step (s).
    cycle_s : float
        Of the nominal frequency (s).
    peak_v : float
        Nominal amplitude of a phase (V).

    Returns
    -------
    float
        The first sample (s) at which a phase differs by more than it did in a cycle before, and by 0.01 pu at least;
        ``seen_s`` where there is none, or the record does not reach far enough back at one step.
    """
    before_s = seen_s - _SOUGHT_CYCLES * cycle_s
    segment = next((part for part in waveforms if part.t0_s <= before_s - 2 * cycle_s and part.end_s >= seen_s), None)
    if segment is None:
        return seen_s
    # Of the cycles before, the calmest: a step that is two cycles back is still seen in the last of them.
    begins_s = [before_s - k * cycle_s for k in range(1, _CYCLES_BEFORE + 1)]
    within_s = [begin_s for begin_s in begins_s if segment.t0_s <= begin_s - cycle_s]
    usual = min(_differences(segment, kind, t, t + cycle_s, cycle_s).max() for t in within_s) / peak_v
    sought = _differences(segment, kind, before_s, seen_s, cycle_s) / peak_v
    departed = np.flatnonzero(sought > max(_LEAST_PU, _ABOVE_BEFORE * usual))
    if not len(departed) or departed[0] == 0:  # at once: of a step before
        return seen_s
    return segment.t0_s + segment.dt_s * float(segment.index_at(before_s) + departed[0])


def _differences(segment: Segment, kind: str, begin_s: float, end_s: float, cycle_s: float) -> Samples:
    """How far the phases are from a cycle before, at each sample that of the phase with the most (V), shape (n,)."""
    begin, end = segment.index_at(begin_s), segment.index_at(end_s) + 1
    t_s = segment.dt_s * np.arange(begin, end)
    first = max(begin - math.ceil(cycle_s / segment.dt_s) - 1, 0)  # a cycle before, and a sample
    grid_s = segment.dt_s * np.arange(first, end)
    phases = (phase[first:end] for phase in segment.three_phase(kind))
    found: Samples = np.abs([x[begin - first :] - np.interp(t_s - cycle_s, grid_s, x) for x in phases]).max(axis=0)
    return found
