"""Slips that happen in every sag, after every sag, or in a normal grid: stated before the run, as in `mutants`."""

from validation.mutations.mutant import RIDE_THROUGH, Mutant
from validation.mutations.slips import Slip, What, When

_IN_SAGS = (
    Mutant(
        "5 % of the current in every sag",
        "Half of the current before is due where operation is mandatory. All support is a twentieth; a current below "
        "0.05 pu has no share; no active power comes.",
        (
            *RIDE_THROUGH,
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
            "active_power_support",
        ),
        slip=Slip(What.CURRENT_TIMES, 0.05),
    ),
    Mutant(
        "5 % of the current from the first sag on for ever",
        "As above, and no power comes back. The compensators leave so little of the voltage's harmonics that it is no "
        "distortion even of a twentieth of the current.",
        (
            *RIDE_THROUGH,
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
            "active_power_support",
            "active_power_recovery",
            "return_to_prefault",
        ),
        slip=Slip(What.CURRENT_TIMES, 0.05, when=When.SAG | When.AFTER | When.SWELL),
    ),
    Mutant(
        "no active power in sags",
        "Reactive power is right, but alone it is less than half of the current before, and at 0.83 pu less than the "
        "0.05 pu that a share is taken of.",
        (*RIDE_THROUGH, "active_power_support", "reactive_ratio"),
        slip=Slip(What.P_IS, 0.0),
    ),
    Mutant(
        "active power swings in sags",
        "40 kW up and down at 10 Hz: less than eq (10) leaves, and where there is much power (0.82 pu) the swing "
        "exceeds the current.",
        ("oscillation", "active_power_support", "current_limit"),
        slip=Slip(What.P_SWINGS, 0.08, 10.0),
    ),
    Mutant(
        "support settles fast at a third of what is due",
        "Dynamics are taken against what is due, not against what comes. Where reactive current is all (0.5 pu) "
        "a third of it is less than half of the current before.",
        (
            "ride_through",
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
        ),
        slip=Slip(What.Q_TIMES, 1 / 3),
    ),
    Mutant(
        "support ends after 0.2 s",
        "It leaves the band it had settled in. Where it is all the current (0.5 pu) nothing flows any more; at 0.6 pu, "
        "in the fault of two levels, active power alone is less than half of the current before.",
        (
            "ride_through",
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
        ),
        slip=Slip(What.Q_TIMES, 0.0, begin_s=0.2),
    ),
    Mutant(
        "current drops out five times a second in sags",
        "100 ms on, 100 ms off: no current for more than a cycle, half of all means, support that comes and goes at a "
        "voltage that stands still; each edge has something at 2f, too.",
        (
            *RIDE_THROUGH,
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
            "active_power_support",
            "toggling",
            "oscillation",
            "constant_power",
        ),
        slip=Slip(What.DROPS, 0.0, 5.0),
    ),
    Mutant(
        "trips shortly before the sag is over",
        "0.02 s before the clearing of sags of 0.4 s, where envelope and rows demand all of it.",
        RIDE_THROUGH,
        slip=Slip(What.TRIP, begin_s=0.38),
    ),
)

_AFTERWARDS = (
    Mutant(
        "0.15 pu of reactive power for ever after a sag",
        "The powers are not those before; between two sags the voltage is normal and no reactive power is due.",
        ("return_to_prefault", "reactive_support"),
        slip=Slip(What.Q_PLUS, 0.15, when=When.AFTER),
    ),
    Mutant(
        "0.25 pu of reactive power for ever after a sag",
        "At nominal power this is 1.03 pu of current, and more than the tolerance of the reactive current.",
        ("return_to_prefault", "reactive_support", "reactive_current", "current_limit"),
        slip=Slip(What.Q_PLUS, 0.25, when=When.AFTER),
    ),
    Mutant(
        "1.7 times the current for 45 ms after a sag",
        "Below the peak, over before the current has to be settled: the stage in between is there for it.",
        ("current_limit",),
        slip=Slip(What.CURRENT_TIMES, 1.7, when=When.AFTER, end_s=0.045),
    ),
    Mutant(
        "active power swings for ever after a sag",
        "50 kW up and down at 20 Hz: beyond nominal current, and never within the band of the power before.",
        ("oscillation", "current_limit", "active_power_recovery"),
        slip=Slip(What.P_SWINGS, 0.1, 20.0, when=When.AFTER),
    ),
    Mutant(
        "blocks for 0.2 s in a normal grid after a sag",
        "Power was back and goes away: no ride-through, a late final recovery, and a swing to nothing and back. At "
        "half power the DC regulator has wound up to nominal power meanwhile, which the array does not give: the DC "
        "voltage collapses.",
        (*RIDE_THROUGH, "active_power_recovery", "oscillation", "return_to_prefault", "harmonics"),
        slip=Slip(What.CURRENT_TIMES, 0.0, when=When.AFTER, begin_s=0.3, end_s=0.5),
    ),
    Mutant(
        "trips 20 ms after clearing",
        "The voltage is normal again, and nothing lets the inverter go; at 49 Hz that is for the frequency to judge.",
        (*RIDE_THROUGH, "frequency_ride_through"),
        slip=Slip(What.TRIP, when=When.AFTER, begin_s=0.02),
    ),
    Mutant(
        "trips in a normal grid 0.4 s after clearing",
        "The same when power is back: recovery has been shown by then.",
        (*RIDE_THROUGH, "frequency_ride_through"),
        slip=Slip(What.TRIP, when=When.AFTER, begin_s=0.4),
    ),
    Mutant(
        "orders of the sag for 0.6 s longer",
        "Recovery is late. The last order of a sag is that at 0.85 pu: 15 % less power, and hardly any reactive power.",
        ("active_power_recovery",),
        slip=Slip(What.HOLD, when=When.AFTER, end_s=0.6),
    ),
)

_ALWAYS = (
    Mutant(
        "trips without any reason in a normal grid",
        "1.3 s after the record begins, where no sag has come: in the tests of frequency and angle, which both demand "
        "connection, as does ride-through in every test.",
        ("ride_through", "frequency_ride_through", "phase_jump_ride_through"),
        slip=Slip(What.TRIP, when=When.BEFORE, begin_s=1.8),
    ),
    Mutant(
        "a fifth harmonic of 3 %",
        "More than 2 % of distortion; the fundamental is as it should be, and half a cycle hides the swing at 4f.",
        ("harmonics",),
        slip=Slip(What.TONE, 0.03, 250.0, when=When.ALWAYS),
    ),
    Mutant(
        "direct current before any sag",
        "1 % of the nominal amplitude in phase a.",
        ("dc_injection",),
        slip=Slip(What.TONE, 0.01, 0.0, when=When.BEFORE),
    ),
    Mutant(
        "negative-sequence current in a normal grid",
        "5 % more in one phase; against a balanced voltage it swings the active power at 2f, by 25 kW, which moves the "
        "DC voltage by less than is allowed.",
        ("current_limit", "constant_power"),
        slip=Slip(What.TONE, 0.05, -50.0, when=When.NORMAL),
    ),
    Mutant(
        "0.05 pu of reactive power too much, always",
        "It returns to what it was; but at normal voltage none is due, and at 0.5 pu there is no current to spare.",
        ("reactive_support", "current_limit"),
        slip=Slip(What.Q_PLUS, 0.05, when=When.ALWAYS),
    ),
)

SLIPPED = (*_IN_SAGS, *_AFTERWARDS, *_ALWAYS)
