"""The voltages that codes speak of, as series of a record."""

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.phase_quantities import voltage_amplitude
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
    """Amplitude of the fundamental of the cycle that ends at each sample (pu), shape (n,); see `voltage_amplitude`.

    Raises
    ------
    MeasurementError
        When a voltage is missing.
    """
    if quantity == "positive_sequence":
        return evidence.voltage_positive_pu
    return voltage_amplitude(evidence.voltage_phasors_pu, quantity)
