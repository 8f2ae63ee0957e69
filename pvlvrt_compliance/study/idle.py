"""What is given and does nothing in a run, for want of something else: a table of what needs what.

It is told and not refused: a file of settings holds for many runs, and what one of them leaves aside another needs.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.errors import spelled_of
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.scenario.events import FurtherSag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, own_parameters

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Asked
    from pvlvrt_compliance.study.selection import Assignment

Spell = Callable[[str], str]


class Needs(NamedTuple):
    """What a parameter needs to do anything, in words, and whether a run has it."""

    words: str
    has: Callable[[Parameters, bool], bool]
    """Of the parameters, and whether the controller is the user's own."""


def _algorithms(*names: str) -> Needs:
    words = " or ".join(f"controller.synchronisation={name}" for name in names)
    return Needs(words, lambda parameters, own: not own and parameters.controller.synchronisation in names)


_SWITCHED = Needs("simulation.fidelity=switched", lambda parameters, _: parameters.simulation.fidelity == "switched")
_OWN = Needs("a controller of your own", lambda _, own: own)
_CONVERTER = Needs("sensors.adc_bits above 0", lambda parameters, _: parameters.sensors.adc_bits > 0)
_SETTLING = Needs("simulation.settling_s above 0", lambda parameters, _: parameters.simulation.settling_s > 0)
_NOISE = (
    "sensors.voltage_noise_v",
    "sensors.current_noise_a",
    "sensors.dc_voltage_noise_v",
    "sensors.pv_current_noise_a",
)


def _is_noisy(parameters: Parameters, _: bool) -> bool:
    return any(getattr(parameters.sensors, name.removeprefix("sensors.")) > 0 for name in _NOISE)


NEEDS: Mapping[str, Needs] = {
    "plant.dead_time_us": _SWITCHED,
    "plant.device_drop_v": _SWITCHED,
    "plant.device_resistance_ohm": _SWITCHED,
    "plant.switching_energy_mj": _SWITCHED,
    "simulation.record_settling": _SETTLING,
    "simulation.synchronising_s": _OWN,
    "controller.hold": _OWN,
    "simulation.time_limit_s": _OWN,
    "simulation.opening_limit_s": _OWN,
    "simulation.memory_limit_mb": _OWN,
    "simulation.output_limit_mb": _OWN,
    "simulation.files_limit_mb": _OWN,
    "simulation.files_limit": _OWN,
    "simulation.processes_limit": _OWN,
    "sensors.voltage_range_v": _CONVERTER,
    "sensors.current_range_a": _CONVERTER,
    "sensors.dc_voltage_range_v": _CONVERTER,
    "sensors.pv_current_range_a": _CONVERTER,
    "sensors.noise_seed": Needs(f"one of {', '.join(_NOISE)} above 0", _is_noisy),
    "controller.sogi_gain": _algorithms("msogi-fll", "dsogi-fll"),
    "controller.fll_gain": _algorithms("msogi-fll", "dsogi-fll"),
    "controller.pll_bandwidth_hz": _algorithms("srf-pll", "ddsrf-pll", "dsc-pll"),
    "controller.pll_damping": _algorithms("srf-pll", "ddsrf-pll", "dsc-pll"),
    "controller.pnsd_notch_damping": _algorithms("srf-pll"),
    "controller.ddsrf_filter_ratio": _algorithms("ddsrf-pll"),
}
"""By the name of the parameter; all others do something in every run."""


def _sags(scenario: Scenario) -> bool:
    sags = [scenario.sag, *(event.sag for event in scenario.events if isinstance(event, FurtherSag))]
    return any(sag.depth or sag.angle_deg for sag in sags)


OF_TESTS: Mapping[str, tuple[str, Callable[[TestCase], bool]]] = {
    "xr": ("a grid with a short-circuit ratio ({scr})", lambda test: test.scenario.scr is not None),
    "transformer": ("a sag", lambda test: _sags(test.scenario)),
    "include_long": ("a test that is a long one", lambda test: test.long),
}
"""Options, by their field, that need a test of some kind: in words, and whether a test is one."""

OF_THE_RUN = ("allow_out_of_range", "csv")
"""Options, by their field, that need something else, which `idle` and `idle_in_files` know."""


def idle(asked: "Asked", parameters: Parameters, tests: "Sequence[Assignment]", spell: Spell) -> Iterator[str]:
    """What is given and does nothing here, a sentence each.

    Parameters
    ----------
    asked : Asked
    parameters : Parameters
        What has come of it.
    tests : sequence of Assignment
        Those that are run.
    spell : callable
        As of `make_job`.
    """
    own = asked.controller is not None
    for assignment in asked.settings:
        name = assignment.partition("=")[0].strip()
        needs = NEEDS.get(name)
        if needs is not None and not (own and name.startswith("controller.")) and not needs.has(parameters, own):
            yield f"{spelled_of(spell, 'settings', name)} {name} does nothing here: it needs {needs.words}"
    if asked.allow_out_of_range and not (own and own_parameters(asked.settings)[0]):
        needs_one = f"a parameter of a controller of your own ({spell('settings')} controller.NAME=VALUE)"
        yield f"{spell('allow_out_of_range')} does nothing here: it needs {needs_one}"
    for field, (words, is_one) in OF_TESTS.items():
        if getattr(asked, field) not in (None, False) and not any(is_one(item.test) for item in tests):
            yield f"{spell(field)} does nothing here: it needs {words.format(scr=spell('scr'))}"


def idle_in_files(csv: bool, keeps_waveforms: bool, spell: Spell) -> Iterator[str]:
    """What is asked of the files of a run and does nothing there, a sentence each; ``csv`` is waveforms as CSV, too."""
    if csv and not keeps_waveforms:
        yield f"{spell('csv')} does nothing here: it needs waveforms that are kept ({spell('waveforms')} all or failed)"
