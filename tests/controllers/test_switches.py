"""Trip, block and restart by a controller from outside: what the plant does, and what is recorded of it."""

import numpy as np
import pytest

from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.waveforms.trip_causes import in_words

SCENARIO = Scenario(sag=Sag(depth=0.0), before_s=0.25, duration_s=0.1, after_s=0.1)
STARTS_S = 1.2
"""A controller's clock as the record begins: 0.2 s of synchronising, and one of settling."""
T_C = 40.9568e-6
FROM_S = 0.25
AT = FROM_S + STARTS_S


@pytest.fixture
def run(opened):
    """Record of a controller of ``switching.py``, its only segment."""

    def make(*settings, cls="Switching", **given):
        (segment,) = opened(f"switching.py:{cls}", **given)(SCENARIO, parameters_from(settings)).segments
        return segment

    return make


def currents(segment):
    """Largest phase current at each instant (A)."""
    return np.abs([segment[f"i_{x}_a"] for x in "abc"]).max(axis=0)


@pytest.mark.parametrize("fidelity", ["averaged", "switched"])
def test_a_trip_opens_the_breaker_with_the_controller_as_the_cause(run, fidelity):
    """Two samples after the one that commands it, and as soon as the diodes have ended the current."""
    segment = run(f"simulation.fidelity={fidelity}", trip_at=AT)
    tripped = segment.t_s[segment["trip_cause"] > 0][0]
    assert tripped == pytest.approx(FROM_S + T_C, abs=1.1 * T_C)
    assert {in_words(int(code)) for code in np.unique(segment["trip_cause"])} == {"none", "controller"}
    opened_at = segment.t_s[segment["connected"] == 0][0]
    assert 0.0001 < opened_at - tripped < 0.0006
    assert currents(segment)[segment.t_s > opened_at].max() == 0


@pytest.mark.parametrize("fidelity", ["averaged", "switched"])
def test_a_block_ends_the_current_and_leaves_the_breaker(run, fidelity):
    """The current of 1.4 pu is gone within 0.6 ms, the breaker stays closed, the array charges the link."""
    segment = run(f"simulation.fidelity={fidelity}", cls="WithoutRestart", block_at=AT, unblock_at=AT + 0.02)
    t = segment.t_s
    blocked = (t > FROM_S + 0.0006) & (t < FROM_S + 0.0199)
    assert currents(segment)[t < FROM_S - 0.0001].min() > 800
    assert currents(segment)[blocked].max() == 0
    assert segment["connected"][blocked].min() == 1
    assert segment["trip_cause"][blocked].max() == 0
    assert np.abs(segment["u_a_v"] - segment["u0_a_v"])[blocked].max() < 1e-9
    v = segment["v_dc_v"][blocked]
    i_pv = segment["i_pv_a"][blocked]
    assert v[-1] - v[0] == pytest.approx(np.trapezoid(i_pv, t[blocked]) / 0.065, rel=1e-3)


def test_after_a_block_it_goes_on(run):
    """Without a restart the bridge works again as soon as the block is not commanded any more."""
    segment = run(cls="WithoutRestart", block_at=AT, unblock_at=AT + 0.02)
    assert currents(segment)[segment.t_s > FROM_S + 0.02].max() > 100


@pytest.mark.parametrize(("restart_at", "works"), [(AT + 0.04, True), (AT + 0.01, True), (1e9, False)])
def test_a_restart_is_waited_for(run, restart_at, works):
    """With a restart, a block stays until one is commanded, and for as long as the block itself is."""
    segment = run(block_at=AT, unblock_at=AT + 0.02, restart_at=restart_at)
    i, t = currents(segment), segment.t_s
    goes_on = FROM_S + max(restart_at - AT, 0.02)
    assert i[(t > FROM_S + 0.001) & (t < goes_on)].max() == 0
    assert bool((i[t > goes_on] > 0).any()) is works


def test_switches_do_not_act_before_the_controller_does(run):
    """In the steady state that it sees first, and before the relays are armed, a trip is none; a block does act."""
    assert run(trip_at=0.0)["trip_cause"][0] == 5
    assert run(trip_at=0.0, cls="WithoutRestart")["connected"].max() == 0


@pytest.mark.parametrize(
    ("cls", "said"),
    [
        ("Wrong", "Wrong.switches is ('trip', 'open'); allowed are trip, block, restart, each once"),
        ("TooFew", "step() must return six numbers (m_a, m_b, m_c, trip, block, restart), not ("),
    ],
)
def test_switches_that_are_none(opened, cls, said):
    """A name that is none, and a step that leaves them out, are told."""
    with pytest.raises(PvlvrtError) as error:
        opened(f"switching.py:{cls}")(SCENARIO, parameters_from(()))
    assert said in str(error.value)


def test_a_switch_that_is_no_number_is_an_error(run):
    """It is told with its name and the instant, before a trip as any other command."""
    with pytest.raises(PvlvrtError, match=r"a command of the controller is not a finite number at .*, block = nan"):
        run(cls="NoSwitch")


def test_what_a_blocked_bridge_is_commanded_does_not_count(run):
    """Regulators wind up while nothing they command acts: no range holds then."""
    segment = run(cls="WoundUp")
    assert currents(segment)[segment.t_s > 0.12].max() == 0
