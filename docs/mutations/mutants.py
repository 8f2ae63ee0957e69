"""What is wrong with each controller or plant of the table, and which checks have to fail for it: stated, not found."""

from later_mutants import LATER
from mutant import RIDE_THROUGH, Mutant
from slipped_mutants import SLIPPED
from unnoticed import UNNOTICED
from wrong_controllers import Wrong

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

_CURRENTS = (
    Mutant(
        "no room for the negative sequence",
        "S_fault = V+ S instead of (V+ - V-) S: the phase with the most current exceeds its limit, and the larger "
        "currents of both sequences store energy in the filter that swings at 2f.",
        ("current_limit", "dc_ripple"),
        wrong=Wrong.NO_ROOM_FOR_NEGATIVE,
    ),
    Mutant(
        "current sensors read 10 % low",
        "The currents are 11 % larger than asked for, in the sag and while the DC link discharges after it; the "
        "regulator of the DC voltage sets the power right, and more support than demanded is no failure.",
        ("current_limit",),
        ("sensors.current_gain=[0.9,0.9,0.9]",),
    ),
    Mutant(
        "voltage sensors read 10 % low",
        "A deeper sag than there is asks for more reactive current than demanded (0.30 pu at V+ = 0.83 pu), and S_nom"
        " at a voltage of 0.9 pu for 11 % too much current while the DC link discharges. It leaves less for the active "
        "power, and does not come down to what is due when a fault steps from 0.62 to 0.7 pu.",
        ("current_limit", "reactive_current", "active_power_support", "support_dynamics"),
        ("sensors.voltage_gain=[0.9,0.9,0.9]",),
    ),
    Mutant(
        "current sensor of phase a reads 10 % low",
        "Phase a carries 11 % more than the others: it exceeds its limit, and the negative sequence of a third of "
        "that swings the active power at 2f at all times.",
        ("current_limit", "constant_power"),
        ("sensors.current_gain=[0.9,1,1]",),
    ),
    Mutant(
        "current sensor of phase a with an offset of 10 A",
        "The regulator makes what it reads free of direct current: two thirds of the offset flow in phase a, 0.9 % of"
        " nominal.",
        ("dc_injection",),
        ("sensors.current_offset_a=[10,0,0]",),
    ),
    Mutant(
        "no harmonic compensators",
        "5 % of the 5th and of the 7th harmonic in the voltage drive currents that K_P alone holds back.",
        ("harmonics",),
        ("controller.hc5_integral_gain=0", "controller.hc7_integral_gain=0"),
    ),
    Mutant(
        "a tenth of the gain at resonance",
        "The current regulator settles ten times as slowly and leaves an error of both sequences: the current of the "
        "worst phase is too large after 60 ms, the power swings "
        "and is less than it should be.",
        ("current_limit", "constant_power", "active_power_support"),
        ("controller.pr_integral_gain=0.01",),
    ),
    Mutant(
        "frequency not followed",
        "At 50.7 Hz generators and regulators sit beside the fundamental: the current is off its angle, which is "
        "reactive power that no one asked for. At 49 Hz V+ and V- are not told apart cleanly, and the active power "
        "swings.",
        ("reactive_support", "constant_power"),
        ("controller.fll_gain=0",),
    ),
)

_POWER = (
    Mutant(
        "active power stays low",
        "0.4 pu is the limit once a sag is over, in a swell that follows, too.",
        ("active_power_recovery", "return_to_prefault", "active_power_support"),
        wrong=Wrong.P_STAYS_LOW,
    ),
    Mutant(
        "active power comes back slowly",
        "From 0.2 pu on by 1.5 pu/s: 0.5 s where 0.3 s are allowed, and long back at the end of the record, but "
        "not in a swell that follows. At half power it overshoots by what the DC link has stored.",
        ("active_power_recovery", "active_power_support", "oscillation"),
        wrong=Wrong.P_COMES_BACK_SLOWLY,
    ),
    Mutant(
        "stuck in fault mode",
        "P and Q of the end of the sag go on after it, P in a swell that follows, too; of Q hardly any was left at "
        "0.85 pu.",
        ("active_power_recovery", "return_to_prefault", "active_power_support"),
        wrong=Wrong.FAULT_STAYS,
    ),
    Mutant(
        "reactive power stays",
        "A tenth of nominal is left after the sag, which adds half a percent to the current; between two sags none "
        "is due.",
        ("return_to_prefault", "reactive_support"),
        wrong=Wrong.Q_STAYS,
    ),
    Mutant(
        "winds up",
        "P* cannot follow during the sag and the integral grows. Afterwards it asks for S_nom until it has run down: "
        "at half power, more than the array gives. The DC voltage collapses, the bridge runs out of voltage and "
        "distorts, stops feeding for a while and swings.",
        ("ride_through", "active_power_recovery", "return_to_prefault", "harmonics", "oscillation"),
        wrong=Wrong.WINDS_UP,
    ),
    Mutant(
        "slow regulator of the DC voltage",
        "A tenth of K_P and a hundredth of K_I: P* follows the DC voltage over seconds, in a fault "
        "that eases and in a swell, too.",
        ("active_power_recovery", "return_to_prefault", "active_power_support"),
        ("controller.dc_proportional_gain_w_per_v=400", "controller.dc_integral_gain_w_per_vs=1500"),
    ),
    Mutant(
        "takes active power in a sag",
        "0.2 pu from the grid, which is too much in a balanced sag. At 0.5 pu it adds to a reactive current that is "
        "nominal alone. "
        "As the current turns round it is next to nothing, when half of that before is due (phase c to 0.1 pu: in one "
        "of the two runs).",
        (*RIDE_THROUGH, "consumption", "current_limit", "active_power_support"),
        wrong=Wrong.P_FLOWS_BACK,
    ),
    Mutant(
        "halves its power at 50.4 Hz",
        "No droop that a code allows asks for that at 50.7 Hz; it comes back with the frequency.",
        ("overfrequency_power",),
        wrong=Wrong.FALLS_WITH_FREQUENCY,
    ),
)

MUTANTS = (*_RELAYS, *_SUPPORT, *_CURRENTS, *_POWER, *SLIPPED, *LATER, *UNNOTICED)
