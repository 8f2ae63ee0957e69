"""The voltages that codes speak of, as series of a record."""

from typing import Literal

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.no_load import has_source
from pvlvrt_compliance.measure.phase_quantities import amplitudes_for, of_amplitudes
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


Place = Literal["terminals", "no_load"]
"""Where a voltage is looked at: with the inverter's current, or of the source without it."""


def voltage_quantity_pu(evidence: Evidence, quantity: VoltageQuantity, place: Place = "terminals") -> Samples:
    """Amplitude of the fundamental of the cycle that ends at each sample (pu), shape (n,).

    Without the inverter's current where ``place`` says so; in a record that has no such voltages, at the terminals.

    Raises
    ------
    MeasurementError
        When a voltage is missing.
    """
    at: Place = "no_load" if place == "no_load" and has_source(evidence) else "terminals"
    return evidence.once(("voltage", quantity, at), lambda: _made(evidence, quantity, at))


def _made(evidence: Evidence, quantity: VoltageQuantity, place: Place) -> Samples:
    if quantity == "positive_sequence":
        return evidence.voltage_positive_pu if place == "terminals" else evidence.sequence_pu("u0", 0)
    kind = "u0" if place == "no_load" else "u"
    if quantity.endswith("line_to_line"):
        phasors = evidence.voltage_phasors_of_pu(kind)
        amplitudes = evidence.once(("line_to_line", kind), lambda: amplitudes_for(phasors, quantity))
    else:
        amplitudes = evidence.phase_amplitudes_pu(kind)
    return of_amplitudes(amplitudes, quantity)
