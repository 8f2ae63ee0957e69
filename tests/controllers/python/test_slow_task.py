"""A second rate beside the fast one."""

import json

import numpy as np
import pytest

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.program.hello import hello_in
from pvlvrt_compliance.controllers.python.tasks import every
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.door.exchange import RAREST
from pvlvrt_compliance.simulation.parameters import parameters_from

SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
QUICK = parameters_from(("simulation.settling_s=0.2",))


def test_the_slow_task_runs_before_the_first_and_every_25th_sample(opened):
    """Whatever has been seen before the record begins counts, too: the two never drift apart."""
    (segment,) = opened("slow.py:Slow")(SCENARIO, QUICK).segments
    assert np.array_equal(segment["slow"], np.ceil(segment["fast"] / 25))
    assert np.array_equal(segment["together"], segment["slow"])
    assert segment["slow"][-1] > 20


def test_a_slow_task_without_a_period_is_refused(opened):
    """What is missing is named, with what is allowed."""
    with pytest.raises(
        PvlvrtError, match=r"WithoutPeriod\.every is None; for step_slow\(\) it must be a whole number of s"
    ):
        opened("slow.py:WithoutPeriod")


@pytest.mark.parametrize(("period", "allowed"), [(RAREST, True), (RAREST + 1, False)])
def test_the_longest_period_is_the_same_for_a_class_and_a_program(period, allowed):
    """What the one may have, the other may."""
    controller = type("Slow", (), {"every": period, "step_slow": lambda *_: None})()
    hello = json.dumps({"version": 1, "sample_time_s": 1e-4, "every": period}).encode()
    for found in (lambda: every(controller), lambda: hello_in(hello).every):
        if allowed:
            assert found() == period
        else:
            with pytest.raises(DoorError, match=f"every.*{RAREST}"):
                found()
