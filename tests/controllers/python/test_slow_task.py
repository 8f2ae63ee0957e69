"""A second rate beside the fast one."""

import numpy as np
import pytest

from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
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
