"""Package and C twin: two programs of the same equations, each the other's oracle."""

import math
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from pvlvrt_compliance.simulation import loop
from pvlvrt_compliance.simulation.columns import CHANNELS

pytestmark = pytest.mark.compiler


@pytest.mark.parametrize(
    "name",
    [
        "three-phase 90 % for 500 ms (trips)",
        "isolated two-phase 80 % at 200 W/m2",
        "three-phase 90 % at SCR 5",
    ],
)
def test_twin_gives_the_waveforms_of_the_package(
    twin_module: ModuleType, agreement: ModuleType, twin: Any, name: str
) -> None:
    """Every channel of the C program's record equals the package's, and both end alike."""
    mine, theirs = (twin_module.arguments_of(twin_module.SCENARIOS[name]) for _ in range(2))
    outcome, other = loop.run(*mine), twin.run(theirs)
    assert (outcome.status, outcome.period, outcome.plant.trip) == (other.status, other.period, other.plant.trip)
    apart = agreement.differences(mine.samples, theirs.samples)
    assert {channel: x for channel, x in apart.items() if x > agreement.TOLERANCE} == {}


@pytest.mark.parametrize(
    ("channel", "nominal"),
    [("u_b_v", math.sqrt(2) * 230), ("i_c_a", math.sqrt(2) * 500e3 / 690), ("v_dc_v", 1e3), ("p_ref_w", 500e3)],
)
def test_difference_of_one_sample_is_noticed(agreement: ModuleType, channel: str, nominal: float) -> None:
    """One sample that is off by a part of nominal shows as that part, in its channel only."""
    record = np.ones((5, len(CHANNELS)))
    other = record.copy()
    other[3, CHANNELS.index(channel)] += 1e-3 * nominal
    apart = agreement.differences(record, other)
    assert apart.pop(channel) == pytest.approx(1e-3)
    assert set(apart.values()) == {0.0}


def test_sample_that_nobody_wrote_is_noticed(agreement: ModuleType) -> None:
    """A sample that is not a number counts as an infinite difference."""
    record = np.ones((5, len(CHANNELS)))
    record[2, CHANNELS.index("u_a_v")] = math.nan
    assert agreement.differences(record, record)["u_a_v"] == math.inf
