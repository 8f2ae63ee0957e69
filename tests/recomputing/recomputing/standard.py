"""Thresholds and windows of a profile that states none of its own."""

THRESHOLDS = {
    "settled_cycles": 1.1,
    "voltage_floor_pu": 0.003,
    "least_sequence_pu": 0.01,
    "least_difference_pu": 0.1,
    "least_source_pu": 0.05,
    "frequency_settled_cycles": 4.1,
    "terminals_settled_cycles": 5.0,
    "frequency_deviation_hz": 0.2,
    "frequency_accuracy_hz": 0.01,
    "angle_accuracy_deg": 0.1,
    "least_fundamental_fraction": 1e-3,
    "window_voltage_floor_pu": 0.005,
    "other_frequency_hz": 0.05,
    "record_slack_s": 0.01,
    "normal_jump_deg": 5.0,
    "normal_jump_s": 0.2,
    "no_power_pu": 0.02,
    "voltage_tolerance_pu": 0.001,
    "response_band": 0.1,
    "response_least_pu": 0.05,
    "uncertainty_instant_s": 0.001,
}
WINDOWS = {
    "before_start_s": 0.22,
    "before_end_s": 0.02,
    "during_start_s": 0.10,
    "during_end_s": 0.02,
    "after_length_s": 0.2,
    "after_clearing_s": 1.1,
}
