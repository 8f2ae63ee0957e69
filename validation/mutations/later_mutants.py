"""Slips in a later stretch alone: the second sag, a gap, an inner level of a fault, a swell. The first is right."""

from validation.mutations.mutant import Mutant
from validation.mutations.slips import Slip, What, When

_INNER = Slip(low_pu=0.57, high_pu=0.67)
"""At a voltage that only the inner level of the fault of two levels has (but for the moment of a step)."""

_SECOND_SAG = (
    Mutant(
        "no current in any sag but the first",
        "Phase c at 0.1 pu: neither connection that feeds, nor support, nor active power.",
        (
            "ride_through",
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
            "active_power_support",
        ),
        slip=Slip(What.CURRENT_TIMES, 0.0, first=2),
    ),
    Mutant(
        "50 kW from the grid in the second sag",
        "No zone forbids that in an unbalanced fault, and reactive current goes on; but 119 kW are due.",
        ("active_power_support",),
        slip=Slip(What.P_IS, -0.1, first=2),
    ),
    Mutant(
        "reactive power swings in the second sag",
        "50 kvar at 8 Hz leave the band of the settled response and, at the top, the room for current. The mean is "
        "right enough.",
        ("oscillation", "support_dynamics", "current_limit"),
        slip=Slip(What.Q_SWINGS, 0.1, 8.0, first=2),
    ),
    Mutant(
        "a third of the support in the second sag",
        "Fast, and too little in both sequences. The share that this voltage asks for is met: active power is little.",
        ("reactive_support", "reactive_current", "negative_sequence_current", "support_dynamics"),
        slip=Slip(What.Q_TIMES, 1 / 3, first=2),
    ),
    Mutant(
        "support 60 ms late in the second sag",
        "Means are taken from 100 ms on.",
        ("support_dynamics",),
        slip=Slip(What.Q_TIMES, 0.0, first=2, end_s=0.06),
    ),
    Mutant(
        "sign of Q reversed in the second sag",
        "More reactive power is taken than an unbalanced fault allows; active power is as it should be.",
        (
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
            "consumption",
        ),
        slip=Slip(What.Q_TIMES, -1.0, first=2),
    ),
    Mutant(
        "negative sequence reversed in the second sag",
        "It raises V- and makes the active power swing at 2f, and the DC voltage with it.",
        ("negative_sequence_current", "constant_power", "dc_ripple"),
        slip=Slip(What.NEGATIVE_TIMES, -1.0, first=2),
    ),
    Mutant(
        "balanced currents in the second sag",
        "As without any negative-sequence current, in that sag.",
        ("negative_sequence_current", "constant_power", "dc_ripple"),
        slip=Slip(What.NEGATIVE_TIMES, 0.0, first=2),
    ),
    Mutant(
        "8 % too much current in the second sag",
        "Of everything; more support and more power than due are no failure.",
        ("current_limit",),
        slip=Slip(What.CURRENT_TIMES, 1.08, first=2),
    ),
    Mutant(
        "orders of before for 80 ms of the second sag",
        "Nominal power at 0.7 pu with V- = 0.3 pu takes 2.5 times the nominal current; the relay opens at 2.0 pu, "
        "which is the limit of the peak.",
        ("ride_through",),
        slip=Slip(What.HOLD, first=2, end_s=0.08),
    ),
    Mutant(
        "trips in the second sag",
        "After 0.1 s, where 1.26 s are demanded. What was before the trip is too short to settle.",
        ("ride_through",),
        slip=Slip(What.TRIP, first=2, begin_s=0.1),
    ),
)

_LATER = (
    Mutant(
        "1.4 times the current for 45 ms after the second sag",
        "The stage of the current holds after each step.",
        ("current_limit",),
        slip=Slip(What.CURRENT_TIMES, 1.4, when=When.AFTER, first=2, end_s=0.045),
    ),
    Mutant(
        "active power stays low after the second sag",
        "Recovery is judged after each, and the end is not as before.",
        ("active_power_recovery", "return_to_prefault"),
        slip=Slip(What.P_AT_MOST, 0.4, when=When.AFTER, first=2),
    ),
    Mutant(
        "orders of the second sag for 0.35 s longer",
        "A late recovery. Its last order is that at 0.85 pu, where hardly any reactive power is left.",
        ("active_power_recovery",),
        slip=Slip(What.HOLD, when=When.AFTER, first=2, end_s=0.35),
    ),
    Mutant(
        "no current in a swell",
        "Connection that feeds and active power are due above nominal voltage, too.",
        ("ride_through", "active_power_support"),
        slip=Slip(What.CURRENT_TIMES, 0.0, when=When.SWELL),
    ),
    Mutant(
        "reactive power in a swell",
        "0.1 pu where none is wanted: within the tolerance of the current, not within that of the power.",
        ("reactive_support",),
        slip=Slip(What.Q_PLUS, 0.1, when=When.SWELL),
    ),
    Mutant(
        "trips in a swell",
        "At 1.15 pu operation is continuous.",
        ("ride_through",),
        slip=Slip(What.TRIP, when=When.SWELL, begin_s=0.1),
    ),
    Mutant(
        "overcurrent by a swell",
        "It asks for four times the current; the relay opens at 2.0 pu, which is the limit of the peak.",
        ("ride_through",),
        slip=Slip(What.CURRENT_TIMES, 4.0, when=When.SWELL),
    ),
)

_INNER_LEVEL = (
    Mutant(
        "no current in the inner level of a fault",
        "Both the levels around it are right.",
        (
            "ride_through",
            "reactive_support",
            "reactive_current",
            "support_dynamics",
            "reactive_ratio",
            "active_power_support",
        ),
        slip=_INNER._replace(what=What.CURRENT_TIMES, amount=0.0),
    ),
    Mutant(
        "40 kW from the grid in the inner level of a fault",
        "Less than the 50 kW of the zones, but 188 kW are due there.",
        ("active_power_support",),
        slip=_INNER._replace(what=What.P_IS, amount=-0.08),
    ),
    Mutant(
        "5 % too much current in the inner level of a fault",
        "A limit of 1.02 pu holds there, too.",
        ("current_limit",),
        slip=_INNER._replace(what=What.CURRENT_TIMES, amount=1.05),
    ),
    Mutant(
        "trips in the inner level of a fault",
        "0.25 s after the fault began, where the envelope demands 1.1 s.",
        ("ride_through",),
        slip=_INNER._replace(what=What.TRIP, begin_s=0.25),
    ),
)

LATER = (*_SECOND_SAG, *_LATER, *_INNER_LEVEL)
