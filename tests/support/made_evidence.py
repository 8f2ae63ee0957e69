"""Evidence of a record made by hand: a balanced voltage of some levels, and whatever other channels a test gives."""

import numpy as np

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import STANDARD_RULES
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
INNER = {"kind": "sag", "t_s": 0.2, "duration_s": 0.15, "sag": {"depth": 0.8}}
DT_S = 1e-4


def evidence_of(
    duration_s: float = 0.6,
    events=(INNER,),
    levels=((0.0, 1.0), (0.3, 0.7), (0.5, 0.2), (0.65, 0.7), (0.9, 1.0)),
    **channels,
):
    """A balanced voltage of these levels, and whatever other channels are given, as functions of time."""
    scenario = Scenario(sag=Sag(depth=0.3), duration_s=duration_s, events=events)
    t = DT_S * np.arange(int(scenario.end_s / DT_S))
    begins, level = zip(*levels, strict=True)
    u = np.sqrt(2) * 230 * np.array(level)[np.searchsorted(begins, t, side="right") - 1]
    angle = 2 * np.pi * (50 * t - np.arange(3)[:, np.newaxis] / 3)
    made = dict(zip(("u_a_v", "u_b_v", "u_c_v"), u * np.cos(angle), strict=True))
    waveforms = Waveforms((Segment(0.0, DT_S, made | {name: f(t) for name, f in channels.items()}),))
    asked = disturbance_asked(scenario, NORMAL)
    return Evidence(
        waveforms=waveforms,
        nominal=Nominal(),
        disturbance=asked,
        available_power_w=500e3,
        measurements=measure(waveforms, Nominal(), asked.start_s, asked.clear_s),
        rules=STANDARD_RULES,
        blocked_below_pu=0.01,
    )
