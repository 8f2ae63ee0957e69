"""What simulated records are measured with."""

from pvlvrt_compliance.evidence.instruments import BY_DEFINITION, Instruments
from pvlvrt_compliance.profile.procedure import TestCase


def instruments_for(test: TestCase) -> Instruments:
    """What to measure the record of a test with: compiled functions for the rows of a table.

    A sag of the user's own is measured by numpy sooner than anything is compiled for it. It goes by the test alone, so
    that a test has the same digits whatever is run with it, and whatever has been compiled before.
    """
    if not test.row:
        return BY_DEFINITION
    from pvlvrt_compliance.simulation.streaming.averages import mean_powers, sequence_phasors
    from pvlvrt_compliance.simulation.streaming.frequency import tracked_frequency

    return Instruments(sequence_phasors, mean_powers, tracked_frequency)
