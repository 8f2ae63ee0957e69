"""A linear filter by every door gives what scipy's gives, call by call, and what differs is found where it does."""

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from pvlvrt_compliance.controllers.replay.replaying import Asked, replay
from pvlvrt_compliance.report.replayed import Replayed, as_csv
from pvlvrt_compliance.simulation.parameters import Parameters

pytestmark = pytest.mark.compiler

DOORS = ("python", "c", "fmi2", "fmi3", "json", "binary")
COUNT = 300
SHARE = 1e-12
"""What the two may differ by, of the peak: they add the same numbers in another order."""


@pytest.fixture(scope="module")
def signals():
    """Three voltages (V) of noise with steps in them, and what a filter of second order makes of them by scipy."""
    random = np.random.default_rng(5)
    u = random.normal(0, 100, (3, COUNT)) + np.where(np.arange(COUNT) > 100, 200.0, -50.0)
    return u, lfilter(*butter(2, 0.1), u / 400)


@pytest.fixture
def files(written, signals):
    """Write the signals for a door: inputs, and what is expected."""

    def files(made, rows=slice(None), **step):
        _, names, unit, outputs = made
        u, m = signals
        inputs = written("in.csv", {name: unit * x for name, x in zip(names, u[:, rows], strict=True)}, **step)
        return inputs, written("out.csv", dict(zip(outputs, m[:, rows], strict=True)), **step)

    return files


def asked(made, inputs, expect=None, **more):
    """What is asked for."""
    return Asked(made[0], str(inputs), None if expect is None else str(expect), **more)


@pytest.mark.parametrize("door", DOORS)
def test_a_filter_gives_what_scipy_gives(low_pass, files, signals, door):
    """With ports by their own names, in volts, kilovolts and without a unit: no plant has a part in it."""
    made = low_pass(door)
    found = replay(asked(made, *files(made), tolerances=(f"{SHARE}",)), {}, Parameters())
    assert (found.status, len(found.agreements)) == (0, 3)
    for each, expected in zip(found.agreements, signals[1], strict=True):
        assert each.largest == np.abs(found.outputs[each.name] - expected).max()
        assert len(each.found) == COUNT


@pytest.mark.parametrize("door", DOORS)
def test_a_gain_that_is_set_is_seen(low_pass, files, signals, door):
    """An error of 0.1 % is outside of 0.09 %, and inside of 0.11 %."""
    made = low_pass(door)
    inputs, expect = files(made)
    given = {"gain": 1.001}
    outside = replay(asked(made, inputs, expect, tolerances=("0.09%",)), given, Parameters())
    inside = replay(asked(made, inputs, expect, tolerances=("0.11%",)), given, Parameters())
    assert (outside.status, inside.status) == (1, 0)
    for each, expected in zip(outside.agreements, signals[1], strict=True):
        off = 1e-3 * np.abs(expected)
        assert each.largest == pytest.approx(off.max(), rel=1e-9)
        assert each.rms == pytest.approx(1e-3 * np.sqrt((expected**2).mean()), rel=1e-9)
        assert each.share == pytest.approx(1e-3, rel=1e-9)
        assert each.first.sample == np.flatnonzero(off > 0.9e-3 * np.abs(expected).max())[0]
        assert each.first.at_s == pytest.approx(1e-4 * each.first.sample)
        assert each.shifted == 0


@pytest.mark.parametrize("door", ["python", "c", "fmi3", "binary"])
def test_a_wrong_sample_is_found(low_pass, files, written, signals, door):
    """One sample of one output that is off is told with its time and both values."""
    made = low_pass(door)
    inputs, _ = files(made)
    wrong = signals[1].copy()
    wrong[1, 217] += 1e-3
    expect = written("wrong.csv", dict(zip(made[3], wrong, strict=True)))
    found = replay(asked(made, inputs, expect), {}, Parameters())
    assert [each.is_inside for each in found.agreements] == [True, False, True]
    each = found.agreements[1]
    assert (each.outside, each.first.sample) == (1, 217)
    assert each.first.at_s == each.at_s == pytest.approx(0.0217)
    assert each.first.expected - each.first.found == pytest.approx(1e-3, rel=1e-6)


@pytest.mark.parametrize("late", [-2, -1, 1, 2])
def test_outputs_that_are_late_are_told(low_pass, files, written, signals, late):
    """What is as expected but some samples later or earlier: a delay that is counted twice, or not at all."""
    made = low_pass("python")
    inputs, _ = files(made)
    early = np.roll(signals[1], -late, axis=1)[:, 5:-5]
    expect = written("early.csv", dict(zip(made[3], early, strict=True)), t0_s=5e-4)
    found = replay(asked(made, inputs, expect), {}, Parameters())
    assert [each.shifted for each in found.agreements] == [late] * 3
    assert found.status == 1
    assert (
        f"{expect}: compared at {COUNT - 10} of {COUNT} samples, with {COUNT - 10} of {COUNT - 10} rows" in found.notes
    )


@pytest.mark.parametrize("door", ["python", "c", "fmi2", "json"])
def test_what_is_written_is_expected_again(low_pass, files, tmp_path, door):
    """The outputs as a file are those of the next replay, to the last bit."""
    made = low_pass(door)
    inputs, _ = files(made)
    first = replay(asked(made, inputs), {}, Parameters())
    assert (first.status, first.agreements) == (0, ())
    kept = tmp_path / "kept.csv"
    kept.write_text(as_csv(Replayed(first.title, first.outputs, first.units, ())), "utf-8")
    again = replay(asked(made, inputs, kept, tolerances=("0",)), {}, Parameters())
    assert again.status == 0
    assert {each.name for each in again.agreements} == set(first.outputs.channels)
    assert all(each.largest == 0 for each in again.agreements)
