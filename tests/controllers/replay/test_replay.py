"""What a controller is told in a replay, what it may do wrong there, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.replay.replaying import Asked, replay
from pvlvrt_compliance.errors import UnfinishedError, UsageError
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from

CLASSES = Path(__file__).parents[1] / "replayed_classes.py"
T = 1e-4
U = np.linspace(-1.0, 3.0, 100)


@pytest.fixture
def of(written):
    """Replay a class: ``of("Told", expect=columns, how="nan", ...)``."""

    def of(name, expect=None, inputs=None, parameters=None, **given):
        file = written("in.csv", inputs or {"u_a_v": U})
        expected = None if expect is None else str(written("out.csv", expect))
        return replay(Asked(f"{CLASSES}:{name}", str(file), expected), given, parameters or Parameters())

    return of


def test_a_class_is_told_time_slow_task_and_rating(of):
    """By the host: its clock begins at 0, the slow task is due in every fifth sample, the rating can be set."""
    found = of("Told", parameters=parameters_from(("plant.apparent_power_kva=200",))).outputs
    assert found["m_a"] == pytest.approx(T * np.arange(100), abs=1e-15)
    assert found["m_b"].tolist() == [k // 5 + 1 for k in range(100)]
    assert set(found["m_c"]) == {200e3}


@pytest.mark.parametrize("from_s", [0.0, 0.005])
def test_what_a_class_reads_without_a_column_is_refused(of, from_s):
    """All that it reads in that sample, by name, and when it does."""
    with pytest.raises(UsageError, match="no column for 2 inputs of the controller: i_dc_a, enabled;"):
        of("Reads", from_s=from_s)


def test_a_class_gets_what_it_reads(of):
    """From a column, or held."""
    inputs = {"u_a_v": U, "i_dc_a": 2 * U, "enabled": np.ones(100)}
    assert of("Reads", inputs=inputs).outputs["m_a"] == pytest.approx(3 * U + 1)


def test_what_is_never_read_is_not_missed(of):
    """Its first reading is after the last sample."""
    assert of("Reads", from_s=1.0).outputs["m_a"] == pytest.approx(U)


@pytest.mark.parametrize(("how", "value"), [("nan", "not a number"), ("inf", "-inf")])
def test_what_is_no_number_is_told_where_first(of, how, value):
    """It is written, and the status says that it is of no use."""
    found = of("Wrong", how=how)
    assert found.status == 3
    assert found.notes == (f"m_a is {value} in 50 samples, first at 0.005 s (sample 50)",)
    assert np.isfinite(found.outputs["m_a"]).tolist() == [True] * 50 + [False] * 50


def test_what_is_no_number_is_outside_unless_expected(of):
    """Against a number the error is infinite, from the first such sample on."""
    expected = {"m_a": U, "m_b": np.ones(100)}
    outside = of("Wrong", expect=expected)
    assert outside.status == 1
    one, other = outside.agreements
    assert (one.largest, one.first.sample, one.outside, other.is_inside) == (np.inf, 50, 50, True)
    assert any("nothing is expected of the outputs m_c" in note for note in outside.notes)
    same = of("Wrong", expect={"m_a": np.where(np.arange(100) < 50, U, np.nan)})
    assert same.status == 0


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("raises", r"the controller failed at 0\.0050 s: step\(\) failed: .*lost its way"),
        ("dies", r"the controller ended the process \(status 7\) at 0\.0050 s\nit had printed: no more sense"),
        ("reset", r"reset\(\) failed: .*not in this mood"),
    ],
)
def test_a_controller_that_fails_ends_the_replay(of, how, words):
    """With the time, the reason, and what it had printed."""
    with pytest.raises(UnfinishedError, match=f"(?s)replayed_classes.py:Wrong: .*{words}"):
        of("Wrong", how=how)


@pytest.mark.parametrize(
    ("how", "limit"), [("hangs", "simulation.time_limit_s=1"), ("memory", "simulation.memory_limit_mb=300")]
)
def test_the_limits_of_a_run_hold(of, how, limit):
    """A controller that comes to one is ended; the limit is named, and how it is raised."""
    name = limit.partition("=")[0]
    with pytest.raises(UnfinishedError, match=rf"{name}.* --set {name}= allows more"):
        of("Wrong", how=how, parameters=parameters_from((limit,)))


def test_further_signals_are_outputs(of):
    """By their names, with the unit that these end in; they can be expected."""
    found = of("Odd", expect={"p_ref_w": np.full(100, 3.0)})
    assert list(found.outputs.channels) == ["m_a", "m_b", "m_c", "twice_v", "p_ref_w"]
    assert (found.units["twice_v"], found.agreements[0].unit, found.status) == ("V", "W", 0)


def test_columns_of_others_are_told(of):
    """What is no input and no output; an output among the inputs says nothing."""
    found = of("Odd", inputs={"u_a_v": U, "speed": U, "m_a": U, "time": U}, expect={"m_a": 0 * U, "u_b_v": U, "x": U})
    told = [note.partition(": ")[2] for note in found.notes]
    assert [words for words in told if "columns" in words] == [
        "columns that are no input and no output: speed",
        "columns that are no input and no output: x",
    ]


def test_outputs_of_which_none_is_expected_are_refused(of):
    """A file that has none of them is the wrong one; so is a tolerance for none."""
    with pytest.raises(UsageError, match=r"no column is an output of the controller; it has m_a, m_b, m_c"):
        of("Odd", expect={"speed": U})


def test_a_tolerance_is_for_an_output(written):
    """For one that there is."""
    file = str(written("in.csv", {"u_a_v": U}))
    asked = Asked(f"{CLASSES}:Told", file, file, tolerances=("ma=1",))
    with pytest.raises(UsageError, match=r'--tolerance ma=: the controller has no such output; did you mean "m_a"'):
        replay(asked._replace(expect=str(written("out.csv", {"m_b": U}))), {}, Parameters())


@pytest.mark.compiler
def test_every_type_of_number_goes_in_and_out(compiled, written):
    """Whole numbers rounded and within their type, those of no number 0, as in a run; no port commands anything."""
    kinds = ("char", "real64", "int8", "uint8", "int16", "real32", "uint16", "int32", "uint32")
    x = np.array([0.4, 1.5, -2.5, 1e12, -1e12, np.nan])
    columns = {f"of_{kind}": x for kind in kinds}
    columns |= {f"wide_{kind}[{k}]": x + k for kind in kinds for k in range(3)}
    asked = Asked(str(compiled("types.c")), str(written("in.csv", columns)))
    given = dict.fromkeys((f"of_{kind}" for kind in kinds), 0) | {"text": "", "after": 0.0}
    found = replay(asked, given, Parameters()).outputs
    for kind in ("char", "int8", "uint8", "int16", "uint16", "int32", "uint32"):
        limits = np.iinfo({"char": "int8"}.get(kind, kind))
        due = [0, 2, max(-2, limits.min), limits.max, limits.min, 0]
        assert found[f"of_{kind}"].tolist() == due, kind
        due = np.clip(np.floor(np.where(np.isnan(x), 0, x + 2) + 0.5), limits.min, limits.max)
        assert found[f"wide_{kind}[2]"].tolist() == due.tolist(), kind
    np.testing.assert_array_equal(found["of_real64"], x)
    np.testing.assert_array_equal(found["wide_real32[1]"], (x + 1).astype(np.float32))
