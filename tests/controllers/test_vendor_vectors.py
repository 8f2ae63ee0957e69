"""The vendor's vectors: computed from what the model is defined to do, what its code gives, and what notices a slip."""

import importlib.util
import sys
from functools import cache

import numpy as np
import pytest
from vendor_model import EXAMPLE

from pvlvrt_compliance.cli.main import run

SLACK = 1e-9  # of each output's largest value


def loaded(name):
    """A module of the example."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLE / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


VECTORS, MODEL = loaded("vectors"), loaded("lcl1000")


@cache
def in_ports(**which):
    """Inputs and expected outputs in the units of the ports."""
    inputs, outputs = VECTORS.computed(**which)
    return VECTORS.of_ports(inputs), VECTORS.of_ports(outputs)


def replayed(inputs, **more):
    """Outputs of the law in Python."""
    law = MODEL.Law(**(MODEL.LCL1000().parameters | more))
    rows = np.array([inputs[name] for name in MODEL.Inputs._fields]).T.tolist()
    steps = [law.step(MODEL.Inputs(*row)) for row in rows]
    return {name: np.array([float(step[name]) for step in steps]) for name in steps[0]}


def furthest(found, expected):
    """Largest error of any output, by the largest that is expected of it."""
    names = found.keys() & expected.keys()
    assert names == expected.keys() - {"t_s"}
    return max(np.abs(found[name] - expected[name]).max() / np.abs(expected[name]).max() for name in names)


@pytest.mark.parametrize("which", [{}, {"is_one_filter": True}, {"is_ceasing": True}], ids=str)
def test_the_law_gives_what_the_vectors_expect(which):
    """Every output at every sample, of 2.3 s in which all of its parts have something to do."""
    inputs, expected = in_ports(**which)
    more = {"MC_enable": 1} if "is_ceasing" in which else {}
    assert furthest(replayed(inputs, **more), expected) < SLACK


def test_the_vectors_reach_every_part():
    """It is held, works, is limited by v_DC, has an open breaker, sees no voltage, and trips at last."""
    inputs, expected = in_ports()
    assert {0.0, 1.0} == set(inputs["Run"]) == set(inputs["CB_closed"]) == set(expected["TRIP"])
    length = np.hypot(expected["Ea"], (expected["Eb"] - expected["Ec"]) / np.sqrt(3))
    is_limited = length > 0.999999 * inputs["Vdc"] / np.sqrt(3)
    assert 0 < is_limited.mean() < 0.1
    assert expected["Vpos"].min() < VECTORS.LEAST_VOLTAGE
    assert expected["Vpos"].max() > VECTORS.V_HIGH
    assert expected["Q_ref"].min() < 0 < expected["Q_ref"].max()


def test_cessation_blocks_before_the_trip():
    """And for its release after the voltage is back: longer than without, and not for ever."""
    _, expected = in_ports()
    _, ceasing = in_ports(is_ceasing=True)
    assert expected["BLOCK"].sum() == expected["TRIP"].sum() < ceasing["BLOCK"].sum()
    assert (ceasing["TRIP"] == expected["TRIP"]).all()


SLIPS = {
    **{"Ki": 1.001, "X1": 1.01, "Kdc": 1.01, "Kfrt": 1.01, "Ksync": 1.001, "Tfreq": 1.001, "P_ramp": 1.01},
    **{"UV2_delay": 1.0002, "Vlow": 1.001, "Vhigh": 1.001, "Imax": 1.001, "Sbase": 1.001, "VLLbase": 1.001},
}


@pytest.mark.parametrize("name", SLIPS)
def test_another_parameter_is_noticed(name):
    """Each by a hundred times the tolerance, or more."""
    inputs, expected = in_ports()
    given = MODEL.LCL1000().parameters[name] * SLIPS[name]
    assert furthest(replayed(inputs, **{name: given}), expected) > 100 * SLACK


@pytest.mark.parametrize(("one", "other"), [("I1", "I2"), ("VC", "VG")])
def test_the_sides_of_the_filter_cannot_be_mixed_up(one, other):
    """Taken for each other, the currents or the voltages give something else."""
    inputs, expected = in_ports()
    mixed = inputs | {f"{a}{x}": inputs[f"{b}{x}"] for a, b in ((one, other), (other, one)) for x in "abc"}
    assert furthest(replayed(mixed), expected) > 1e-3


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """All vectors, in files."""
    folder = tmp_path_factory.mktemp("vectors")
    VECTORS.main(folder)
    return folder


@pytest.mark.compiler
@pytest.mark.parametrize(
    ("form", "name", "more"),
    [
        ("c", "", ()),
        ("c", "cessation-", ("--set", "controller.MC_enable=1")),
        ("c", "plant-", ()),
        ("fmu", "", ()),
        ("fmu", "cessation-", ("--set", "controller.MC_enable=1")),
        ("fmu", "plant-", ()),
        ("python", "plant-", ()),
    ],
)
def test_every_form_replays_them(vendor_forms, folder, capfd, form, name, more):
    """By the command, every output within a share of 1e-9 of its peak."""
    files = ("--inputs", str(folder / f"{name}inputs.csv"), "--expect", str(folder / f"{name}expected.csv"))
    status = run(["controllers", "replay", vendor_forms[form], *files, "--tolerance", "0.0000001%", *more])
    said = capfd.readouterr()
    assert status == 0, said
    assert "all as expected: 12 outputs compared" in said.out
