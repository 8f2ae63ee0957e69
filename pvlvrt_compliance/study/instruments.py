"""What simulated records are measured with."""

from pvlvrt_compliance.evidence.instruments import BY_DEFINITION, Instruments, WindowInstruments
from pvlvrt_compliance.profile.procedure import TestCase


def instruments_for(test: TestCase) -> Instruments:
    """What to measure the record of a test with: compiled functions for the rows of a table.

    A sag of the user's own is measured by numpy sooner than anything is compiled for it. It goes by the test alone, so
    that a test has the same digits whatever is run with it, and whatever has been compiled before.
    """
    return compiled_instruments() if test.row else BY_DEFINITION


def compiled_instruments() -> Instruments:
    """Compiled functions for whatever simulated records are measured with."""
    from pvlvrt_compliance.simulation.streaming import averages, frequency, harmonics, whole_cycles

    return Instruments(
        sequence_phasors=averages.sequence_phasors,
        mean_powers=averages.mean_powers,
        tracked_frequency=frequency.tracked_frequency,
        sequence_current=averages.sequence_current,
        sequence_amplitudes=averages.sequence_amplitudes,
        phase_amplitudes=averages.phase_amplitudes,
        windows=WindowInstruments(
            sums=whole_cycles.window_sums,
            harmonics=harmonics.harmonic_amplitudes,
            frequency=whole_cycles.fundamental_frequency,
        ),
    )
