"""What is wrong with each controller or plant of the table, and which checks have to fail for it: stated, not found."""

from typing import NamedTuple

from wrong_controllers import Wrong

RIDE_THROUGH = ("ride_through", "repeated_runs")
"""A test that is not ridden through is also a run too few."""


class Mutant(NamedTuple):
    """One wrong controller or plant."""

    name: str
    why: str
    """What is wrong, and why that fails just these checks."""
    fails: tuple[str, ...]
    settings: tuple[str, ...] = ()
    """What `--set` takes."""
    wrong: Wrong | None = None
    """A mistake that no setting can make."""


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
        "It trips at 50.7 Hz, where the bands demand connection for ever; no other test has such a frequency.",
        ("frequency_ride_through",),
        ("protection.frequency_max_hz=50.5",),
    ),
    Mutant(
        "gives up at a jump of the angle",
        "A vector-shift relay: V+ turns by more than 12 deg against its own past, and the bridge stops for good. Sags"
        " leave the angle of V+ alone.",
        ("phase_jump_ride_through",),
        wrong=Wrong.GIVES_UP_AT_A_JUMP,
    ),
    Mutant(
        "never comes back",
        "The bridge stops at the first fault for good, with the breaker closed: no power returns, and nothing is left"
        " that another check could judge.",
        RIDE_THROUGH,
        wrong=Wrong.NEVER_COMES_BACK,
    ),
    Mutant(
        "pauses below 0.6 pu",
        "Momentary cessation where operation is mandatory, so no reactive current either; at 0.7 pu and above it is "
        "right. Without current there is no response to time and no share.",
        ("ride_through", "reactive_support", "reactive_current"),
        wrong=Wrong.CEASES,
    ),
)

_SUPPORT = (
    Mutant(
        "no reactive power",
        "All of S_fault goes to active power, the currents stay where they belong. Nothing moves whose response could"
        " be timed.",
        ("reactive_support", "reactive_current", "negative_sequence_current", "reactive_ratio"),
        wrong=Wrong.NO_SUPPORT,
    ),
    Mutant(
        "half the reactive power",
        "Half the plateau of eq (9) halves its slope too, in both sequences.",
        ("reactive_support", "reactive_current", "negative_sequence_current", "reactive_ratio"),
        ("controller.reactive_plateau_pu=0.375",),
    ),
    Mutant(
        "sign of Q reversed",
        "Reactive power is taken from the grid and pulls both sequences the wrong way, as fast as it should be fed.",
        ("reactive_support", "reactive_current", "negative_sequence_current", "reactive_ratio", "consumption"),
        wrong=Wrong.Q_REVERSED,
    ),
    Mutant(
        "support 45 ms late",
        "Active current alone for 45 ms, within the limits. The response then takes 56 to 60 ms, of 50 ms allowed; "
        "all means are taken from 100 ms on.",
        ("support_dynamics",),
        wrong=Wrong.Q_LATE,
    ),
    Mutant(
        "support swings at 10 Hz",
        "Between 60 and 100 % of eq (9): a fifth less on average is too little where the tolerance is a tenth of the "
        "nominal current (at 0.5 pu), leaves the band of the settled response, and undercuts the share at its lowest.",
        ("reactive_support", "reactive_current", "support_dynamics", "reactive_ratio"),
        wrong=Wrong.Q_SWINGS,
    ),
    Mutant(
        "support toggles near the threshold",
        "Above 0.75 pu it goes off for 30 ms five times a second. On average 15 % less is within the tolerances; "
        "without it the share is none.",
        ("toggling", "reactive_ratio"),
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
        "pu it takes a fifth and a half more, without support, and swings the DC voltage where the sag is unbalanced.",
        (*RIDE_THROUGH, "current_limit", "reactive_support", "reactive_ratio", "dc_ripple"),
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
        " at a voltage of 0.9 pu for 11 % too much current while the DC link discharges.",
        ("current_limit", "reactive_current"),
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
        "worst phase is too large after 60 ms, and the power swings.",
        ("current_limit", "constant_power"),
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
        "0.4 pu is the limit once a sag is over.",
        ("active_power_recovery", "return_to_prefault"),
        wrong=Wrong.P_STAYS_LOW,
    ),
    Mutant(
        "active power comes back slowly",
        "From 0.2 pu on by 1.5 pu/s: 0.5 s where 0.3 s are allowed, and long back at the end of the record.",
        ("active_power_recovery",),
        wrong=Wrong.P_COMES_BACK_SLOWLY,
    ),
    Mutant(
        "stuck in fault mode",
        "P and Q of the sag go on after it.",
        ("active_power_recovery", "return_to_prefault"),
        wrong=Wrong.FAULT_STAYS,
    ),
    Mutant(
        "reactive power stays",
        "A tenth of nominal is left after the sag, which adds half a percent to the current.",
        ("return_to_prefault",),
        wrong=Wrong.Q_STAYS,
    ),
    Mutant(
        "winds up",
        "P* cannot follow during the sag and the integral grows. Afterwards it asks for S_nom until it has run down: "
        "at half power, more than the array gives. The DC voltage collapses, the bridge runs out of voltage and "
        "distorts.",
        ("active_power_recovery", "return_to_prefault", "harmonics"),
        wrong=Wrong.WINDS_UP,
    ),
    Mutant(
        "slow regulator of the DC voltage",
        "A tenth of K_P and a hundredth of K_I: P* follows the DC voltage over seconds.",
        ("active_power_recovery", "return_to_prefault"),
        ("controller.dc_proportional_gain_w_per_v=400", "controller.dc_integral_gain_w_per_vs=1500"),
    ),
    Mutant(
        "takes active power in a sag",
        "0.2 pu from the grid, which is too much in a balanced sag. At 0.5 pu it adds to a reactive current that is "
        "nominal alone.",
        ("consumption", "current_limit"),
        wrong=Wrong.P_FLOWS_BACK,
    ),
    Mutant(
        "halves its power at 50.4 Hz",
        "No droop that a code allows asks for that at 50.7 Hz; it comes back with the frequency.",
        ("overfrequency_power",),
        wrong=Wrong.FALLS_WITH_FREQUENCY,
    ),
)

UNNOTICED = (
    Mutant(
        "three more samples of computation",
        "A delay of 4.5 periods instead of 1.5: at the crossover of 629 Hz (validation.md) that is 28 deg of a phase "
        "margin of more than 60 deg.",
        (),
        ("controller.computation_delay_samples=4",),
    ),
    Mutant(
        "resonators without lead",
        "The lead makes up for the delay, 14 deg at the 13th harmonic. Without it the poles of the current loop "
        "(validation.md) still lie inside the unit circle, and the compensators remove the 5th and the 7th all the "
        "same.",
        (),
        ("controller.resonator_lead_samples=0",),
    ),
    Mutant(
        "DC voltage sensor reads 10 % high",
        "The search for the maximum-power point finds it at another reading; no power depends on the scale.",
        (),
        ("sensors.dc_voltage_gain=1.1",),
    ),
)
"""Mistakes that leave every requirement met."""

MUTANTS = (*_RELAYS, *_SUPPORT, *_CURRENTS, *_POWER, *UNNOTICED)
