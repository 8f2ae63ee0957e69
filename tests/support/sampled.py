"""Shipped tests that between them have every kind of check, simulated and judged once a process."""

from functools import cache

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.run import Judged, run_test

SAMPLE = (
    "iec61400-21:VD3-full-1",
    "rey-boue-500kva:fig15-50hz",
    "es-po-12.3:PVVC-2-1",
    "es-po-12.3:PVVC-4-1",
    "es-nts-631-lt110kv:U40TPmax-1",
    "es-nts-631-lt110kv:U75TPmax-1",
    "es-nts-631-lt110kv:U75BPmed-1",
    "es-nts-631-lt110kv:LFSM-O-step",
    "dk-rfg:phase-jump-extreme-30",
    "dk-rfg:fault-scr-frequency-full",
    "nerc-prc-029:1.195pu-1s-full",
    "nerc-prc-029:cumulative-0.255pu",
    "ieee1547-cat-ii:0.460pu-0.32s",
    "nerc-prc-029:phase-jump-ahead-full",
    "ieee1547-cat-ii:1.165pu-0.5s",
    "ieee1547-cat-ii:steady-full",
)
"""Main job, sags of one phase, of two and of three, a trip, frequency and angle, over-voltage, regions."""


@cache
def sampled(name: str) -> Judged:
    """The test ``profile:id``, with its evidence."""
    profile_name, _, test_id = name.partition(":")
    profile = load_profile(profile_name, INSTALLED_KINDS)
    test = next(test for test in profile.tests() if test.id == test_id)
    return run_test(profile, test, Parameters())
