"""The voltage that the grid has without the inverter's current, where a check asks what the inverter made of it."""

from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.measure.durations import mean_over_time
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.waveforms.container import Samples


def has_source(evidence: Evidence) -> bool:
    """Whether the record has the voltages without the inverter's current."""
    return "u0_a_v" in evidence.waveforms.names


def no_load_series_pu(evidence: Evidence, index: int) -> Samples:
    """One-cycle amplitude of a sequence (0 positive, 1 negative) without the inverter's current (pu), shape (n,).

    At the terminals in a record that has no such voltages: they then decide.
    """
    return evidence.sequence_pu("u0" if has_source(evidence) else "u", index)


def no_load_mean_pu(evidence: Evidence, span: Span) -> tuple[float, float]:
    """Means of V+ and V- of `no_load_series_pu` over a span that holds a sample (pu).

    Raises
    ------
    MeasurementError
        When a voltage is missing or not finite.
    """
    inside = evidence.samples(*span)
    positive, negative = (
        require_finite(no_load_series_pu(evidence, index)[inside], "the no-load voltage", evidence.t_s[inside])
        for index in (0, 1)
    )
    weights = evidence.step_s[inside]
    return mean_over_time(positive, weights), mean_over_time(negative, weights)
