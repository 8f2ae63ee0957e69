"""Floors and thresholds of measurement and judging that codes leave open, as numbers with marks."""

from typing import Any

from pvlvrt_compliance.data.marks import CHOSEN, Frozen, NotNegative, Number, Positive


def _chosen(value: float, source: str) -> Any:
    return Number(value=value, confidence=CHOSEN, source=source)


class Thresholds(Frozen):
    """What decides whether something is judged, and how exactly; a profile may state its own."""

    normal_low_pu: Positive = _chosen(0.9, "lowest voltage of normal operation in every code at hand, or nearly")
    normal_high_pu: Positive = _chosen(1.1, "highest voltage of normal operation in every code at hand, or nearly")
    normal_negative_pu: NotNegative = _chosen(0.1, "as far from balanced as the lowest normal voltage is from nominal")
    settled_cycles: NotNegative = _chosen(1.1, "a one-cycle voltage shows a step within a cycle, and a sample or two")
    voltage_floor_pu: Positive = _chosen(0.003, "below it noise of a sensor turns the angle that current is split by")
    least_sequence_pu: Positive = _chosen(0.01, "twice the error of 0.5 % that test equipment is allowed")
    least_source_pu: Positive = _chosen(0.05, "noise of 0.5 % a sample at 24 kHz turns it as 0.07 Hz would")
    frequency_settled_cycles: NotNegative = _chosen(
        4.1,
        "what a frequency rests on and settles in: a step into the worst isolated two-phase fault leaves 0.17 Hz after"
        " two cycles, when all windows lie behind it, and 3 mHz after these",
    )
    terminals_settled_cycles: NotNegative = _chosen(
        5.0,
        "from a voltage that is normal again until the current behind it has settled: then the angle of the terminals"
        " is the grid's but for a constant (a short-circuit ratio of 2 leaves under 0.1 Hz)",
    )
    frequency_deviation_hz: Positive = _chosen(
        0.2, "first thresholds of a power that follows the frequency are 50.2 Hz and 49.8 Hz (NTS 631)"
    )
    frequency_accuracy_hz: NotNegative = _chosen(0.010, "accuracy that NTS 631 v2.0 demands of the measurement")
    angle_accuracy_deg: NotNegative = _chosen(0.1, "how well a jump is known from one-cycle phasors")
    least_fundamental_fraction: Positive = _chosen(1e-3, "of the rated current, below which no distortion is stated")
    window_voltage_floor_pu: Positive = _chosen(0.005, "V+ of a window below which no frequency of it is stated")
    other_frequency_hz: NotNegative = _chosen(
        0.05, "a window further than this from the frequency before the disturbance is measured at its own"
    )
    record_slack_s: NotNegative = _chosen(0.01, "by how much a record may end early: a sampling step, a coarse one too")


STANDARD_THRESHOLDS = Thresholds()
