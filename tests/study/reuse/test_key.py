"""Everything that decides a record is part of its key: edited, it is simulated anew."""

import json
import shutil
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from reused import DEFAULTS, SCENARIO

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.events import PhaseJump, Recording
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameter_names, parameters_from
from pvlvrt_compliance.study.reuse.key import key_of
from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.comtrade import write_comtrade

OTHER_SCENARIO: dict[str, Any] = {
    "sag": Sag(depth=0.5, phases="c"),
    "duration_s": 0.25,
    "point_on_wave_deg": 1e-9,
    "frequency_hz": 50.1,
    "irradiance_w_m2": 999.0,
    "cell_temperature_c": 26.0,
    "scr": 10.0,
    "xr": 9.0,
    "vector_group": "Dyn11",
    "reactive_power_pu": 0.1,
    "before_s": 0.31,
    "after_s": 1.2,
    "events": (PhaseJump(t_s=0.1, angle_deg=10.0),),
}

OTHER_WORDS = {
    "controller.precision": "single",
    "protection.undervoltage_curve": [[0, 0], [0.05, 0], [0.4, 0.85]],
}
"""Values of parameters that are no numbers, where the type does not say which there are."""


def test_what_has_not_changed_is_simulated_once(simulated):
    """The next run takes what the first one has stored."""
    assert (simulated(), simulated(), simulated()) == (1, 0, 0)


@pytest.mark.parametrize("name", Scenario.model_fields)
def test_every_field_of_a_scenario_counts(name):
    """There is another value for each of them here, so that none can be added unnoticed."""
    other = Scenario(**{**{n: getattr(SCENARIO, n) for n in SCENARIO.model_fields_set}, name: OTHER_SCENARIO[name]})
    assert key_of(other, DEFAULTS, None, None) != key_of(SCENARIO, DEFAULTS, None, None)


def test_another_scenario_and_other_parameters_are_simulated(simulated):
    """Each is stored beside the others."""
    longer, weaker = (
        SCENARIO.model_copy(update={"duration_s": 0.3}),
        parameters_from(["controller.pr_integral_gain=0.2"]),
    )
    asked = [{}, {"scenario": longer}, {"parameters": weaker}]
    assert [simulated(**each) for each in (*asked, *asked)] == [1, 1, 1, 0, 0, 0]


def others_of(name, value):
    """Values that a parameter may have instead, those of its type first."""
    group, _, key = name.partition(".")
    annotation = str(type(getattr(DEFAULTS, group)).model_fields[key].annotation)
    words = [word.strip("' \"") for word in annotation.partition("Literal[")[2].partition("]")[0].split(",")]
    numbers = (
        [] if isinstance(value, bool) or not isinstance(value, int | float) else [value + 1, 1.01 * value, value / 2]
    )
    flags = [not value] if isinstance(value, bool) or "bool" in annotation else []
    return [*flags, *numbers, *filter(None, words), OTHER_WORDS.get(name), [1.0, 1.1, 1.0], 0.5, 5.0]


def with_another(name):
    """Parameters of which one has another value."""
    group, _, key = name.partition(".")
    for other in others_of(name, getattr(getattr(DEFAULTS, group), key)):
        try:
            found = parameters_from([f"{name}={json.dumps(other)}"])
        except UsageError:
            continue
        if found != DEFAULTS:
            return found
    raise AssertionError(f"{name}: no other value is known here")


@pytest.mark.parametrize("name", parameter_names())
def test_every_parameter_counts(name):
    """Those of plant, controller, hardware, protection and simulation."""
    assert key_of(SCENARIO, with_another(name), None, None) != key_of(SCENARIO, DEFAULTS, None, None)


def test_a_parameter_that_is_given_counts_even_at_its_default(simulated):
    """A controller from outside settles for another time unless it is set."""
    given = parameters_from([f"simulation.settling_s={DEFAULTS.simulation.settling_s}"])
    assert given == DEFAULTS
    assert (simulated(), simulated(parameters=given)) == (1, 1)


def csv_recording(folder):
    """A scenario with a recording in CSV, and the file that decides it."""
    (folder / "grid.csv").write_text("t_s,u_a_v,u_b_v,u_c_v\n0,1,2,3\n1,1,2,3\n")
    return folder / "grid.csv", folder / "grid.csv"


def comtrade_recording(folder):
    """The same of COMTRADE, whose samples are in a file beside it."""
    channels = {f"u_{phase}_v": np.arange(4.0) for phase in "abc"}
    waveforms = Waveforms((Segment(0.0, 1e-3, channels),))
    write_comtrade(waveforms, folder / "grid", station="s", device="d", frequency_hz=50.0, start=None)
    return folder / "grid.cfg", folder / "grid.dat"


@pytest.mark.parametrize("recording", [csv_recording, comtrade_recording])
def test_what_is_in_a_recording_counts(simulated, tmp_path, recording):
    """Not its time and place: the same file, written anew, is the same recording."""
    named, deciding = recording(tmp_path)
    scenario = SCENARIO.model_copy(update={"events": (Recording(file=str(named), t_s=0.1),)})
    assert (simulated(scenario), simulated(scenario)) == (1, 0)
    content = deciding.read_bytes()
    deciding.write_bytes(content)
    moved = shutil.copytree(tmp_path, tmp_path / "elsewhere")
    assert simulated(SCENARIO.model_copy(update={"events": (Recording(file=str(moved / named.name), t_s=0.1),)})) == 0
    assert simulated(SCENARIO.model_copy(update={"events": (Recording(file=str(named), t_s=0.2),)})) == 1
    deciding.write_bytes(content[:-2] + bytes([content[-2] ^ 1]) + content[-1:])
    assert (simulated(scenario), simulated(scenario)) == (1, 0)


def edited(**changes):
    """Change something that the controller says of itself."""
    return lambda own, _: replace(own, description=replace(own.description, **changes))


def written(name, text):
    """Write a file beside the mapping."""

    def write(own, folder):
        (folder / name).write_text(text)
        return own

    return write


OF_THE_CONTROLLER = {
    "its file": edited(digest="e" * 64),
    "its kind": edited(kind="fmi2"),
    "its name": edited(name="mine 1.1"),
    "its sample time": edited(sample_time_s=2e-4),
    "its specification": lambda own, _: replace(own, spec="my.py:Other"),
    "its parameters": lambda own, _: replace(own, given={"gain": 1.5}),
    "a parameter that is given as it is": lambda own, _: replace(own, given={"gain": 1.0, "limit": 2.0}),
    "its mapping": written("ctrl.mapping.toml", 'files = ["gains.csv", "lib/*.py"]\n# edited'),
    "no mapping": edited(mapping=None),
    "a file that the mapping lists": written("gains.csv", "2"),
    "a file of a pattern": written("lib/b.py", "2"),
    "a file that a pattern finds besides": written("lib/c.py", "1"),
    "the bundled one": lambda *_: None,
}


@pytest.mark.parametrize("what", OF_THE_CONTROLLER)
def test_what_a_controller_is_made_of_counts(simulated, own, tmp_path, what):
    """Its file, its parameters, its mapping and what that lists."""
    assert (simulated(controller=own), simulated(controller=own)) == (1, 0)
    other = OF_THE_CONTROLLER[what](own, tmp_path)
    assert (simulated(controller=other), simulated(controller=other)) == (1, 0)


def test_what_nothing_lists_does_not_count(simulated, own, tmp_path):
    """A file that happens to lie beside it is none of the controller's."""
    assert simulated(controller=own) == 1
    (tmp_path / "notes.txt").write_text("x")
    assert simulated(controller=own) == 0
