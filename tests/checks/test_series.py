"""What checks take over time from series whose samples stand for different times."""

import numpy as np
import pytest

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.waveforms.container import Segment, Waveforms


@pytest.mark.parametrize(("late_s", "status"), [(0.28, Status.PASS), (0.29, Status.FAIL)])
def test_mean_over_a_change_of_step(bench, demanding, late_s, status):
    """A record that is eight times coarser in the second half of its sag has the mean of the time, not of the samples.

    From 0.1 s to 0.78 s after the start K = 2 asks for 0.6 pu and at least 0.5 pu; 0.7 pu comes late.
    """
    k_factor = {
        "k": 2.0,
        "dead_band_pu": 0.0,
        "dead_band_mode": "none",
        "reference": "prefault",
        "tolerance_plus_pu": 0.2,
        "tolerance_minus_pu": 0.1,
        "limit_pu": 1.0,
        "blocking_allowed_below_pu": 0.2,
    }
    made = bench(
        depth=0.3,
        duration_s=0.8,
        profile=demanding(reactive_current=k_factor),
        p_sag_kw=20.0,  # no bridge that blocks
        q_sag_kvar=lambda t: 500 * 0.7 * np.where(t < late_s, 0.0, 0.7),
    )
    whole = made.waveforms().segments[0]
    middle = 8 * (whole.index_at(0.7) // 8)
    coarse = {name: x[middle::8] for name, x in whole.channels.items()}
    thin = Waveforms(
        (
            whole.slice(0, whole.t0_s + (middle - 0.5) * whole.dt_s),
            Segment(whole.t0_s + middle * whole.dt_s, 8 * whole.dt_s, coarse),
        )
    )
    made.waveforms = lambda: thin
    expected = 0.7 * (0.78 - late_s - 0.01) / 0.68  # a step is in the mean over a cycle half a cycle late
    check = made.check("reactive_current")
    assert check.measured == pytest.approx(expected, abs=1e-3)
    assert check.status is status
