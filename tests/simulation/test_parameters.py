"""Parameters by name: what `--set` reaches, and what it refuses."""

import json
import subprocess
import sys
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.parameters import Parameters, parameter_names, parameters_from

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


@given(st.floats(0, 1e9, allow_nan=False))
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
        ("controller.sogi_gain=0", "--set controller.sogi_gain: .*greater than 0"),
        ("controller.sogi_gain=NaN", "is not a value"),
        ("controller.sogi_gain=true", "valid number"),
        ('controller.sogi_gain="1.2"', "valid number"),
        ("controller.sogi_gain=" + "[" * 30_000, "is not a value"),
        ("controller.sogi_gain=1e999", "finite"),
        ("controller.sogi_gain=null", "--set controller.sogi_gain: .*number"),
        ("simulation.control_ratio=8.5", "--set simulation.control_ratio: .*integer"),
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
