"""A library in a replay: how it is begun, its units by quantity, what it says, and what it may do wrong."""

import numpy as np
import pytest

from pvlvrt_compliance.controllers.replay.replaying import Asked, replay
from pvlvrt_compliance.errors import UnfinishedError, UsageError
from pvlvrt_compliance.simulation.parameters import Parameters

pytestmark = pytest.mark.compiler

T = 1e-4
COUNT = 100
TURN = np.exp(1j * (2 * np.pi * 50 * T * np.arange(COUNT)))
M = {f"m_{phase}": 0.8 * (TURN * np.exp(-2j * np.pi * k / 3)).real for k, phase in enumerate("abc")}
AHEAD = {f"m_{phase}": 0.8 * (TURN * np.exp(2j * np.pi * (0.005 - k / 3))).real for k, phase in enumerate("abc")}
"""What modulates, and the same turned on by a sample."""

V_DC = 700.0
IN = {**M, "v_dc_v": np.full(COUNT, V_DC)}
U_DQ = {
    "u_d_ref_v": V_DC / 2 * 0.8 * np.cos(np.angle(TURN) + 0.01 * np.pi - 0.7),
    "u_q_ref_v": V_DC / 2 * 0.8 * np.sin(np.angle(TURN) + 0.01 * np.pi - 0.7),
    "angle_rad": np.full(COUNT, 0.7),
}
MADE = {(): AHEAD, ("DUTY",): AHEAD, ("FRAME",): U_DQ}


@pytest.mark.parametrize("how", MADE)
def test_quantities_are_expected_in_si(compiled, written, how):
    """Of duties, of voltages in kV and angles in degrees, and of a block that is told by an enable."""
    block = (T * np.arange(COUNT) > 0.00499).astype(float)
    expected = {**MADE[how], "block": block}
    asked = Asked(str(compiled("commanding.c", *how)), str(written("in.csv", IN)), str(written("out.csv", expected)))
    found = replay(asked, {"enable_until": 0.00499}, Parameters())
    assert [(each.name, each.unit) for each in found.agreements if not each.is_inside] == []
    assert len(found.agreements) == 4
    assert found.outputs["pwm_enable"].tolist() == (1 - block).tolist()


def test_a_model_is_initialised_once_with_outputs_of_zero(compiled, written):
    """Before its first sample; its clock is that of its calls, wherever the times of the file begin."""
    asked = Asked(str(compiled("commanding.c")), str(written("in.csv", IN, t0_s=3.0)))
    found = replay(asked, {"enable_until": 0.00499}, Parameters())
    assert set(found.outputs["initialised"]) == {1}
    assert set(found.outputs["began_at"]) == {0}
    assert found.outputs["pwm_enable"].sum() == 50
    assert "time is given the time since the first sample" in found.notes
    assert found.outputs.t0_s == 3.0


def fed(compiled, written, **given):
    """What a library gives that misbehaves; its mapping lies beside it."""
    inputs = written("u.csv", {name: np.zeros(200) for name in ("u_a_v", "u_b_v", "u_c_v", *M)}, 40.9568e-6)
    asked = Asked(str(compiled("misbehaving.c")), str(inputs), None)
    return replay(asked, {"below_v": 1e6, "at_s": 0.004, **given}, Parameters())


def test_what_a_library_says_is_told_once(compiled, written):
    """It goes on with its work; a parameter that it has changed is told, too."""
    found = fed(compiled, written, how=8)
    assert found.notes == ("the limiter is active",)
    assert found.outputs["calls"].tolist() == list(range(1, 201))
    changed = fed(compiled, written, at_s=66.0).notes
    assert "the controller has changed its parameter at_s from 66.0 to 99.0" in changed


@pytest.mark.parametrize(
    ("how", "words"),
    [
        (1, r"crashed \(SIGSEGV\) at 0\.0040 s"),
        (5, r"the controller failed at 0\.0040 s: the current measurement is implausible"),
        (7, r"the controller ended the process \(status 0\) at 0\.0040 s"),
        (9, r"the controller failed at 0\.0040 s: it gave no reason"),
        (10, r"crashed \(SIGABRT\) at 0\.0040 s"),
    ],
)
def test_a_library_that_fails_ends_the_replay(compiled, written, how, words):
    """With the time that it had come to."""
    with pytest.raises(UnfinishedError, match=words):
        fed(compiled, written, how=how)


def test_what_a_library_prints_is_no_output(compiled, written):
    """Neither JSON nor anything else."""
    assert fed(compiled, written, how=6).status == 0
    assert np.isnan(fed(compiled, written, how=3).outputs["m_b"]).sum() == 102


def test_a_parameter_out_of_its_range_is_refused_or_allowed_and_told(compiled, written):
    """As in a run: the vectors of a maker may be those of another setting than its model allows."""
    u = {f"m[{k}]": np.sin(np.arange(50) + k) for k in range(3)}
    asked = Asked(str(compiled("parameterised.c")), str(written("in.csv", u)), str(written("out.csv", u)))
    with pytest.raises(UsageError, match=r"gain: -3\.5 is out of range; 0 to 2 is allowed"):
        replay(asked, {"gain": -3.5}, Parameters())
    found = replay(asked._replace(allow_out_of_range=True), {"gain": -3.5}, Parameters())
    assert (found.status, len(found.agreements)) == (0, 3)
    assert "out of the range that it states, as was allowed: gain = -3.5 (0 to 2)" in found.notes
