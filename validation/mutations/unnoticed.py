"""Mistakes that leave every requirement met, each with the text that leaves it open."""

from validation.mutations.mutant import Mutant
from validation.mutations.slips import Slip, What

UNNOTICED = (
    Mutant(
        "a fifth harmonic of 5 % in sags",
        "Before and after the sag there is none. The fundamental is as it should be.",
        (),
        slip=Slip(What.TONE, 0.05, 250.0),
        left_open="Limits of harmonics are of steady operation: IEEE 1547-2018 7.3 (ten or twelve cycles), paper sec. "
        "5 and Fig. 9. What a sag may distort no text says.",
    ),
    Mutant(
        "three more samples of computation",
        "A delay of 4.5 periods instead of 1.5: at the crossover of 629 Hz (validation.md) that is 28 deg of a phase "
        "margin of more than 60 deg.",
        (),
        ("controller.computation_delay_samples=4",),
        left_open="No text limits a delay or a margin of stability. NTS 631 v2.0 5.11.2.2.4 times the response of the "
        "current, which takes milliseconds less than it may; the paper gives gains (Table 3) and no margin. Were the "
        "margin spent, `oscillation` would see what comes of it.",
    ),
    Mutant(
        "resonators without lead",
        "The lead makes up for the delay, 14 deg at the 13th harmonic. Without it the poles of the current loop "
        "(validation.md) still lie inside the unit circle, and the compensators remove the 5th and the 7th all the "
        "same.",
        (),
        ("controller.resonator_lead_samples=0",),
        left_open="Paper sec. 5 wants undistorted currents under distorted voltages, and they are; how a resonator is "
        "made up for the delay it does not say.",
    ),
    Mutant(
        "DC voltage sensor reads 10 % high",
        "The search for the maximum-power point finds it at another reading; no power depends on the scale.",
        (),
        ("sensors.dc_voltage_gain=1.1",),
        left_open="Every text measures at the terminals; none has a number for a sensor inside or for the efficiency "
        "of a search. `dc_ripple` is in percent of the DC voltage that there is, not of the one that is read.",
    ),
)
