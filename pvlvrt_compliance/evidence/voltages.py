"""The voltages that codes speak of, as series of a record."""

import numpy as np

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.profile.curves import VoltageQuantity
from pvlvrt_compliance.waveforms.container import Samples

NAMES: dict[VoltageQuantity, str] = {
    "positive_sequence": "V+",
    "mean_phase": "the mean phase voltage",
    "lowest_phase": "the lowest phase voltage",
    "highest_phase": "the highest phase voltage",
    "lowest_line_to_line": "the lowest line-to-line voltage",
    "highest_line_to_line": "the highest line-to-line voltage",
}
"""Each quantity in words."""


def voltage_quantity_pu(evidence: Evidence, quantity: VoltageQuantity) -> Samples:
    """Amplitude of the fundamental of the cycle that ends at each sample (pu), shape (n,).

    Line-to-line voltages are in pu of the nominal line-to-line voltage: 1 in a healthy grid, as the phase voltages.

    Raises
    ------
    MeasurementError
        When a voltage is missing.
    """
    if quantity == "positive_sequence":
        return evidence.voltage_positive_pu
    phasors = evidence.voltage_phasors_pu
    amplitudes = np.abs(_line_to_line(phasors) if quantity.endswith("line_to_line") else phasors)
    if quantity == "mean_phase":
        mean: Samples = amplitudes.mean(axis=0)
        return mean
    extreme: Samples = amplitudes.min(axis=0) if quantity.startswith("lowest") else amplitudes.max(axis=0)
    return extreme


def _line_to_line(phasors: ComplexSamples) -> ComplexSamples:
    differences: ComplexSamples = (phasors - np.roll(phasors, -1, axis=0)) / np.sqrt(3)
    return differences
