"""What is wrong with each controller or plant of the table, and which checks have to fail for it: stated, not found."""

from validation.mutations.current_and_power_mutants import CURRENTS_AND_POWER
from validation.mutations.later_mutants import LATER
from validation.mutations.mutant import RIDE_THROUGH, Mutant
from validation.mutations.slipped_mutants import SLIPPED
from validation.mutations.unnoticed import UNNOTICED
from validation.mutations.wrong_controllers import Wrong

RIGHT = Mutant("the right controller", "The paper's control passes every check.", ())

_RELAYS = (
    Mutant(
        "undervoltage relay without delay",
        "It trips 0.05 s after V+ has fallen below 0.85 pu, where the envelope demands 0.9 s at 0.5 pu.",
        RIDE_THROUGH,
        ("protection.undervoltage_curve=[[0,0.85]]",),
    ),
    Mutant(
        "undervoltage relay along a shorter curve",
        "The curve ends after 0.4 s instead of 1.5 s: sags of 0.4 s at 0.5 and 0.7 pu outlast it, one at 0.83 pu does"
        " not.",
        RIDE_THROUGH,
        ("protection.undervoltage_curve=[[0,0],[0.05,0],[0.4,0.85]]",),
    ),
    Mutant(
        "overcurrent relay at 1.6 pu",
        "The first peak of a phase depends on where on the wave the sag begins: of the two runs of a sag of phase c "
        "to 0.1 pu one trips and the other does not, which is why a test is run more than once.",
        RIDE_THROUGH,
        ("protection.overcurrent_pu=1.6",),
    ),
    Mutant(
        "DC overvoltage relay at 950 V",
        "In a deep sag the array is left with no one to take its power and goes towards its open-circuit voltage, "
        "beyond 950 V.",
        RIDE_THROUGH,
        ("protection.dc_overvoltage_v=950",),
    ),
    Mutant(
        "overfrequency relay at 50.5 Hz",
        "It trips at 50.7 Hz, where the bands demand connection for ever; no other test has such a frequency. "
        "A row demands to be ridden through, whatever moves.",
        ("ride_through", "frequency_ride_through"),
        ("protection.frequency_max_hz=50.5",),
    ),
    Mutant(
        "gives up at a jump of the angle",
        "A vector-shift relay: V+ turns by more than 12 deg against its own past, and the bridge stops for good. Sags"
        " leave the angle of V+ alone. No power is left at the end, and what harmonics drive is all the current.",
        ("ride_through", "phase_jump_ride_through", "return_to_prefault", "harmonics"),
        wrong=Wrong.GIVES_UP_AT_A_JUMP,
    ),
    Mutant(
        "never comes back",
        "The bridge stops at the first fault for good, with the breaker closed: no current is support, power or"
        " return, and what harmonics drive is all there is.",
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
            "harmonics",
        ),
        wrong=Wrong.NEVER_COMES_BACK,
    ),
    Mutant(
        "pauses below 0.6 pu",
        "Momentary cessation where operation is mandatory, so no reactive current either; at 0.7 pu and above it is "
        "right. Without current there is neither response nor share, which are due.",
        ("ride_through", "reactive_support", "reactive_current", "support_dynamics", "reactive_ratio"),
        wrong=Wrong.CEASES,
    ),
)

_SUPPORT = (
    Mutant(
        "no reactive power",
        "All of S_fault goes to active power, the currents stay where they belong. A response is due"
        " and does not come.",
        (
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
        ),
        wrong=Wrong.NO_SUPPORT,
    ),
    Mutant(
        "half the reactive power",
        "Half the plateau of eq (9) halves its slope too, in both sequences. It never comes to what is due.",
        (
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
        ),
        ("controller.reactive_plateau_pu=0.375",),
    ),
    Mutant(
        "sign of Q reversed",
        "Reactive power is taken from the grid and pulls both sequences the wrong way, and never comes to what is due.",
        (
            "reactive_support",
            "reactive_current",
            "negative_sequence_current",
            "support_dynamics",
            "reactive_ratio",
            "consumption",
        ),
        wrong=Wrong.Q_REVERSED,
    ),
    Mutant(
        "support 45 ms late",
        "Active current alone for 45 ms. The response then takes 56 to 60 ms, of 50 ms allowed; the turn of the "
        "current is in the cycle that ends at 60 ms, when its limit is 1.02 pu; "
        "all means are taken from 100 ms on.",
        ("support_dynamics", "current_limit"),
        wrong=Wrong.Q_LATE,
    ),
    Mutant(
        "support swings at 10 Hz",
        "Between 60 and 100 % of eq (9): a fifth less on average is too little where the tolerance is a tenth of the "
        "nominal current (at 0.5 pu), leaves the band of the settled response, and undercuts the share at its "
        "lowest. It is a swing.",
        ("reactive_support", "reactive_current", "support_dynamics", "reactive_ratio", "oscillation"),
        wrong=Wrong.Q_SWINGS,
    ),
    Mutant(
        "support toggles near the threshold",
        "Above 0.75 pu it goes off for 30 ms five times a second. On average 15 % less is within the tolerances; "
        "without it the share is none, and 32 kvar go to and fro.",
        ("toggling", "reactive_ratio", "oscillation"),
        wrong=Wrong.Q_TOGGLES,
    ),
    Mutant(
        "negative-sequence reactive current reversed",
        "It raises V- instead of lowering it. Then it is no longer in quadrature with the whole voltage: active power"
        " swings at 2f, and the DC voltage with it.",
        ("negative_sequence_current", "constant_power", "dc_ripple"),
        wrong=Wrong.Q_NEGATIVE_REVERSED,
    ),
    Mutant(
        "no negative-sequence current",
        "Balanced currents against unbalanced voltages let the active power swing at 2f.",
        ("negative_sequence_current", "constant_power", "dc_ripple"),
        ("controller.power_strategy=balanced",),
    ),
    Mutant(
        "distorted references",
        "Strategy 1 has no negative sequence of the fundamental, and third harmonics that the regulators do not "
        "follow: a swing of 15 kW is left, which moves the DC voltage by a third of what is allowed.",
        ("negative_sequence_current", "constant_power"),
        ("controller.power_strategy=constant-p-q",),
    ),
    Mutant(
        "faults detected below 0.6 pu only",
        "At 0.7 pu with V- = 0.3 pu nominal power takes 2.5 times the nominal current, which trips. At 0.82 and 0.83 "
        "pu it takes a fifth and a half more, without support, and swings the DC voltage where the sag is unbalanced. "
        "In a fault of 0.7 and 0.62 pu no support comes, as 0.62 pu draws nearly twice the nominal current.",
        (
            *RIDE_THROUGH,
            "current_limit",
            "reactive_support",
            "reactive_current",
            "support_dynamics",
            "reactive_ratio",
            "dc_ripple",
        ),
        ("controller.fault_threshold_pu=0.6",),
    ),
)

MUTANTS = (*_RELAYS, *_SUPPORT, *CURRENTS_AND_POWER, *SLIPPED, *LATER, *UNNOTICED)
