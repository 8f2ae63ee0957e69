"""Parameters by name: what `--set` reaches, and what it refuses."""

import json
import subprocess
import sys
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.parameter_group import ranges_of
from pvlvrt_compliance.simulation.parameters import (
    LONGEST,
    Parameters,
    own_parameters,
    parameter_names,
    parameters_from,
)

DEFAULTS = Parameters()


def value_of(parameters, name):
    """Value of ``group.name``."""
    group, _, key = name.partition(".")
    return getattr(getattr(parameters, group), key)


def test_reading_parameters_stays_light():
    """Whoever reads `--set` pays for neither the compiler nor a kernel, in whichever room a parameter stands."""
    code = f"import sys, {Parameters.__module__}; print(*sorted(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = run.stdout.split()
    assert not {"numba", "numpy", "pvlvrt_compliance.kernel"} & set(loaded)
    rooms = {f"pvlvrt_compliance.{room}" for room in ("plant", "control", "hardware", "simulation")}
    assert {name for name in loaded if name.rpartition(".")[0] in rooms} == {f"{room}.parameters" for room in rooms}


def test_no_assignment_leaves_the_defaults():
    """The defaults are Table 3 of the paper and the plant's own numbers."""
    assert parameters_from([]) == DEFAULTS
    controller = DEFAULTS.controller
    assert (controller.dc_proportional_gain_w_per_v, controller.dc_integral_gain_w_per_vs) == (3977.5, 152110.0)
    assert (controller.pr_proportional_gain, controller.pr_integral_gain) == (0.0011, 0.1)
    assert controller.grid_voltage_feedforward is False
    assert (DEFAULTS.simulation.plant_step_us, DEFAULTS.simulation.control_ratio) == (5.1196, 8)


def test_protection_follows_no_profile():
    """The relays' defaults are the plant's: 2.0 pu, 1100 V, and an undervoltage curve with 50 ms of grace."""
    protection = DEFAULTS.protection
    assert (protection.overcurrent_pu, protection.dc_overvoltage_v) == (2.0, 1100.0)
    assert protection.undervoltage_curve == ((0.0, 0.0), (0.15, 0.0), (1.5, 0.85))
    assert (protection.undervoltage_delay_s, protection.frequency_delay_s) == (0.05, 0.2)


@pytest.mark.parametrize("name", parameter_names())
def test_every_parameter_can_be_set(name):
    """Each default, written as JSON, is read back under its name and changes nothing."""
    text = json.dumps(DEFAULTS.model_dump(mode="json")[name.partition(".")[0]][name.partition(".")[2]])
    assert parameters_from([f"{name}={text}"]) == DEFAULTS


@given(st.floats(0, 1e4, allow_nan=False))
def test_numbers_are_read_exactly(value):
    """A number arrives as written, and no other parameter moves."""
    parameters = parameters_from([f"controller.pr_integral_gain={value!r}"])
    assert parameters.controller.pr_integral_gain == value
    controller = parameters.controller.model_copy(update={"pr_integral_gain": 0.1})
    assert parameters.model_copy(update={"controller": controller}) == DEFAULTS


@pytest.mark.parametrize(
    ("assignment", "value"),
    [
        ("controller.grid_voltage_feedforward=true", True),
        ("protection.frequency_min_hz=47.5", 47.5),
        ("protection.frequency_min_hz=null", None),
        ("protection.undervoltage_curve=[[0, 0.5], [1, 0.85]]", ((0.0, 0.5), (1.0, 0.85))),
        (" plant.modules_in_series =21", 21),
        ("simulation.fidelity=switched", "switched"),
        ('simulation.fidelity= "switched"', "switched"),
        ("controller.synchronisation=dsc-pll", "dsc-pll"),
        ('controller.power_strategy="constant-q"', "constant-q"),
        ("controller.power_strategy= balanced ", "balanced"),
    ],
)
def test_values_as_in_json(assignment, value):
    """True, null, lists and numbers are written as in JSON; words need no quotes."""
    parameters = parameters_from([assignment])
    assert value_of(parameters, assignment.partition("=")[0].strip()) == value


def test_several_assignments_in_several_groups():
    """Assignments add up."""
    parameters = parameters_from(["plant.apparent_power_kva=250", "controller.sogi_gain=1", "controller.fll_gain=40"])
    assert (parameters.plant.apparent_power_kva, parameters.controller.sogi_gain) == (250, 1)
    assert parameters.controller.fll_gain == 40


@pytest.mark.parametrize(
    ("assignment", "says"),
    [
        ("controller.pr_integral_gian=0.2", 'unknown parameter; did you mean "controller.pr_integral_gain"'),
        ("pr_integral_gain=0.2", 'did you mean "controller.pr_integral_gain"'),
        ("protecton.overcurrent_pu=1", 'did you mean "protection.overcurrent_pu"'),
        ("controller=1", "unknown parameter"),
        ("controler.kp=2", r'unknown parameter; there is no group "controler"; did you mean "controller"\?$'),
        ("controler.pr_integral_gian=2", 'unknown parameter; did you mean "controller.pr_integral_gain"'),
        ("senors.adc_bits=2", r'unknown parameter; did you mean "sensors.adc_bits"\?$'),
        ("nothing.like.it=1", "--set nothing.like.it: unknown parameter$"),
        ("controller.sogi_gain", "write --set group.name=value"),
        ("controller.sogi_gain=", "'' is not a value"),
        ("controller.sogi_gain=fast", "'fast' is not a value; write a number, true, false, null or"),
        ("simulation.fidelity=exact", "--set simulation.fidelity: .*'averaged' or 'switched'"),
        ("simulation.fidelity=1", "--set simulation.fidelity: "),
        ("controller.sogi_gain=0", "--set controller.sogi_gain: 0 is out of range; 0.001 to 1000 is allowed"),
        ("controller.sogi_gain=NaN", "is not a value"),
        ("controller.sogi_gain=true", "must be a number, not True"),
        ('controller.sogi_gain="1.2"', "must be a number, not '1.2'"),
        ("controller.sogi_gain=" + "[" * 1500, "is not a value"),
        ("controller.sogi_gain=1e999", "finite"),
        ("controller.sogi_gain=null", "--set controller.sogi_gain: .*number"),
        ("simulation.control_ratio=8.5", "--set simulation.control_ratio: must be a whole number"),
        ("simulation.control_ratio=0", "--set simulation.control_ratio: "),
        ("controller.grid_voltage_feedforward=2", "--set controller.grid_voltage_feedforward: "),
        ("protection.undervoltage_curve=[]", "--set protection.undervoltage_curve: "),
        ("protection.undervoltage_curve=[[0,0],[0,1]]", "the times of undervoltage_curve must increase"),
        ("controller.fll_frequency_min_hz=80", "fll_frequency_min_hz must be below fll_frequency_max_hz"),
        ("controller.synchronisation=pll", "--set controller.synchronisation: .*'msogi-fll', 'dsogi-fll', 'srf-pll'"),
        ("controller.power_strategy=3", "--set controller.power_strategy: .*'constant-p-q'"),
        ("controller.power_strategy=", "--set controller.power_strategy: .*'constant-p-q'"),
        ("controller.mppt_voltage_max_v=500", "mppt_voltage_min_v must be below mppt_voltage_max_v"),
        ("controller.fault_threshold_pu=0.4", "reactive_plateau_voltage_pu must be below fault_threshold_pu"),
    ],
)
def test_what_is_refused(assignment, says):
    """The message is one line that names the parameter and what is allowed."""
    with pytest.raises(UsageError, match=says) as error:
        parameters_from([assignment])
    assert "\n" not in str(error.value)


def test_given_twice():
    """Two values for one parameter are refused rather than one of them ignored."""
    with pytest.raises(UsageError, match=r"--set controller\.sogi_gain: given twice"):
        parameters_from(["controller.sogi_gain=1", "controller.sogi_gain=2"])


def test_all_problems_at_once():
    """Two values out of range are both named."""
    with pytest.raises(UsageError, match=r"overcurrent_pu.*; .*sogi_gain"):
        parameters_from(["controller.sogi_gain=-1", "protection.overcurrent_pu=-1"])


@given(st.text(max_size=40))
def test_any_text_is_read_or_refused(text):
    """No text that someone may type ends in anything but parameters or a usage error."""
    with suppress(UsageError):
        assert isinstance(parameters_from([f"controller.sogi_gain={text}"]), Parameters)
    with suppress(UsageError):
        assert isinstance(parameters_from([text]), Parameters)


def field_of(name):
    """Field of the models behind ``group.name``."""
    group, _, key = name.partition(".")
    return type(getattr(DEFAULTS, group)).model_fields[key]


def written(name, number, place=0):
    """A parameter with a number, a list with that number in a place; all others of the list as they are by default."""
    value = value_of(DEFAULTS, name)
    if name == "protection.undervoltage_curve":
        points = [[0.0, 0.0], [3600.0, 0.0]]
        points[place or -1][place] = number
        return f"{name}={json.dumps(points)}"
    if isinstance(value, tuple):
        value = [number if k == place else x for k, x in enumerate(value)]
        return f"{name}={json.dumps(value)}"
    return f"{name}={number!r}"


def refusal(assignment):
    """What an assignment is refused for; empty where it is not."""
    try:
        parameters_from([assignment])
    except UsageError as error:
        return str(error)
    return ""


NUMBERS = [
    (name, place, *bounds)
    for name in parameter_names()
    if "float" in str(field_of(name).annotation) or field_of(name).annotation is int
    for place, bounds in enumerate(ranges_of(field_of(name)) or [(None, None)])
]


SWITCHES_OR_NONE = {"protection.undervoltage_relay", "protection.frequency_relay"}
"""Switches that are neither on nor off by default."""


def test_every_number_has_a_range():
    """Words and switches have none."""
    others = set(parameter_names()) - {name for name, *_ in NUMBERS}
    assert all(isinstance(value_of(DEFAULTS, name), (str, bool)) for name in others - SWITCHES_OR_NONE)
    assert {name for name, _, low, high in NUMBERS if low is None or high is None} == set()
    assert len(NUMBERS) > 60


@pytest.mark.parametrize(("name", "place", "low", "high"), NUMBERS)
def test_the_ends_of_a_range_are_in_it_and_nothing_beyond(name, place, low, high):
    """What is just outside is refused with the whole range; a default lies well inside."""
    beyond = [low - 1, high + 1] if field_of(name).annotation is int else [low - 1e-6 * (high - low), high * (1 + 1e-6)]
    for inside in (low, high):
        assert "out of range" not in refusal(written(name, inside, place))
    for outside in beyond:
        assert f"is out of range; {low:g} to {high:g} is allowed" in refusal(written(name, outside, place))
    for absurd in (-1e300, 10**400, 1e308):
        said = refusal(written(name, absurd, place))
        assert any(words in said for words in ("must be a finite number", "must be a whole number", "is out of range"))
    default = value_of(DEFAULTS, name)
    assert default is None or isinstance(default, tuple) or low <= default <= high


@pytest.mark.parametrize(
    ("given", "refused"),
    [
        (["simulation.plant_step_us=0.125"], False),
        (["simulation.plant_step_us=0.12"], True),
        (["simulation.plant_step_us=1000", "simulation.control_ratio=100"], False),
        (["simulation.plant_step_us=1000", "simulation.control_ratio=101"], True),
    ],
)
def test_the_control_period_has_a_range(given, refused):
    """Of step and ratio together, whichever is given."""
    if not refused:
        assert parameters_from(given)
        return
    with pytest.raises(UsageError, match=r"the control period is .* s, .*; 1e-06 s to 0.1 s is allowed"):
        parameters_from(given)


@pytest.mark.parametrize("read", [parameters_from, own_parameters])
def test_a_value_of_any_length_is_refused_at_once(read):
    """In a short line, before anything is made of it; the longest that is read is 2000 characters."""
    longest = "9" * LONGEST
    with suppress(UsageError):
        read([f"controller.sogi_gain={longest}"])
    with pytest.raises(UsageError, match=r"^--set controller.sogi_gain: a value of 2001 characters; 2000 are allowed$"):
        read([f"controller.sogi_gain={longest}9"])
    with pytest.raises(UsageError, match=r"^--set x{40}: a name of 20000 characters; 2000 are allowed$"):
        read(["x" * 20_000 + "=1"])
