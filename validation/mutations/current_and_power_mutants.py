"""Mistakes of the current and of the active power: stated before the run, as in `mutants`."""

from validation.mutations.mutant import RIDE_THROUGH, Mutant
from validation.mutations.wrong_controllers import Wrong

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

CURRENTS_AND_POWER = (*_CURRENTS, *_POWER)
