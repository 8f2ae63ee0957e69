"""The disturbance of a test whose voltage is played back: a scenario knows when that begins, the record what it was."""

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.found import Thresholds, disturbance_found
from pvlvrt_compliance.disturbance.model import Disturbance, Moved, Step, Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.scenario.events import Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms

_NOT_IN_THE_VOLTAGE: tuple[Moved, ...] = ("strength", "irradiance", "harmonics", "recording")
"""What a scenario asks for and a search of the voltage does not find."""


def disturbance_played(
    scenario: Scenario, waveforms: Waveforms, nominal: Nominal, thresholds: Thresholds
) -> Disturbance | None:
    """What the grid did in the record of a scenario that plays a recording back and asks for no sag itself.

    It is what `disturbance_found` finds, but that times count from the first sag or swell where there is one: a
    recording need not begin with the angle that the grid had before it.

    Parameters
    ----------
    scenario : Scenario
    waveforms : Waveforms
        Its record.
    nominal : Nominal
        Base of the per-unit values.
    thresholds : Thresholds

    Returns
    -------
    Disturbance or None
        None where the scenario says it all: it plays nothing back, asks for a sag itself, or nothing is found.
    """
    plays = any(isinstance(event, Recording) for event in scenario.events)
    if not plays or scenario.sag.depth or scenario.sag.angle_deg:
        return None
    try:
        found = disturbance_found(waveforms, nominal, thresholds)
    except MeasurementError:
        return None
    asked = disturbance_asked(scenario, thresholds.normal)
    sag = next((part for part in found.stretches if part.kind != "normal"), None)
    return found.model_copy(
        update={
            "start_s": found.start_s if sag is None else sag.begin_s,
            "record_end_s": asked.record_end_s,
            "steps": _joined(found.steps, asked.steps),
            "stretches": tuple(_with_weather(part, asked) for part in found.stretches),
            "irradiance_w_m2": asked.irradiance_w_m2,
            "in_words": f"{asked.in_words}: {found.in_words}",
            "facts": (*found.facts, *asked.facts),
        }
    )


def _joined(found: tuple[Step, ...], asked: tuple[Step, ...]) -> tuple[Step, ...]:
    """What is found, and of what is asked for that which is not in the voltage."""
    moved = {step.at_s: tuple(what for what in step.moved if what in _NOT_IN_THE_VOLTAGE) for step in asked}
    others = (Step(at_s=at_s, moved=what) for at_s, what in moved.items() if what)
    return tuple(sorted((*found, *others), key=lambda step: step.at_s))


def _with_weather(part: Stretch, asked: Disturbance) -> Stretch:
    there = asked.stretch_at(part.begin_s)
    ramps = tuple(what for what in there.ramps if what == "irradiance")
    return part.model_copy(update={"irradiance_w_m2": there.irradiance_w_m2, "ramps": ramps})
