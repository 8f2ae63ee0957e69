"""Forty tests over all shipped profiles: own sags of every kind, and rows of their tables."""

from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.run import run_test
from pvlvrt_compliance.waveforms.container import Waveforms
from pvlvrt_compliance.waveforms.csv import write_csv

WEAK, WEAKER = {"scr": 6.0, "xr": 10.0}, {"scr": 3.0, "xr": 3.0}
INNER = {"kind": "sag", "t_s": 0.2, "duration_s": 0.15, "sag": {"depth": 0.8}}
SECOND = {"kind": "sag", "t_s": 0.45, "duration_s": 0.25, "sag": {"depth": 0.8, "phases": "c"}}
LEVELS = {"kind": "voltage_profile", "points": [[0, 0.4], [0.3, 0.4], [0.3, 0.7], [0.6, 0.7], [0.8, 1.0]]}
FALLING = {"kind": "frequency_ramp", "t_s": 0.0, "rate_hz_s": -1.0, "duration_s": 1.0}
RISING = {"kind": "frequency_ramp", "t_s": 0.1, "rate_hz_s": 1.5, "duration_s": 0.8}
SHADE = {"kind": "irradiance", "t_s": 0.3, "to_w_m2": 600, "ramp_s": 0.05}
FIFTH = {"kind": "harmonic", "order": 5, "amplitude_pu": 0.06}


def _jump(deg: float) -> dict[str, Any]:
    return {"kind": "phase_jump", "t_s": 0.0, "angle_deg": deg}


def _swell(level: float) -> dict[str, Any]:
    return {"kind": "voltage_profile", "points": [[0, 1.0], [0, level], [0.3, level], [0.3, 1.0]]}


class Case(NamedTuple):
    """One test: a row by its id, or a sag of one's own."""

    profile: str
    row: str = ""
    sag: dict[str, Any] = {}  # noqa: RUF012 - a named tuple's default is never changed
    duration_s: float = 0.4
    fields: dict[str, Any] = {}  # noqa: RUF012

    @property
    def name(self) -> str:
        """For people."""
        events = [event["kind"] for event in self.fields.get("events", ())]
        words = [f"{key}={value:g}" for key, value in self.fields.items() if isinstance(value, float | int)]
        return "-".join([self.profile, self.row or str(self.sag.get("depth", 0)), *events, *words])


def own(profile: str, depth: float, duration_s: float, *events: dict[str, Any], **fields: Any) -> Case:
    """A sag of one's own; phases, two_phase and type are the sag's, the rest the scenario's."""
    sag = {key: fields.pop(key) for key in ("phases", "two_phase", "type") if key in fields}
    return Case(profile, "", {"depth": depth, **sag}, duration_s, {**fields, "events": events} if events else fields)


CASES = (
    own("iec61400-21", 0.6, 0.4),
    own("spain-q-curve", 0.5, 0.4, phases="c"),
    own("es-po-12.3", 0.56, 0.5, **WEAK),
    own("iec61400-21", 0.56, 0.5, **WEAK),
    own("iec61400-21", 0.9, 0.3, **WEAKER),
    own("es-nts-631-ge110kv", 0.9, 0.3, **WEAKER),
    own("nerc-prc-029", 0.9, 0.3, **WEAKER),
    own("es-nts-631-lt110kv", 0.3, 0.6, INNER),
    own("spain-q-curve", 0.3, 0.6, INNER),
    own("dk-rfg", 0.3, 0.6, INNER),
    own("dk-rfg-lt110kv", 0.5, 0.15, SECOND),
    own("es-po-12.3", 0.5, 0.15, SECOND),
    own("rey-boue-500kva", 0.5, 0.15, SECOND),
    own("ieee1547-cat-iii", 0.0, 1.2, FALLING),
    own("dk-rfg-dk2", 0.0, 1.5, RISING),
    own("nerc-prc-029", 0.0, 0.5, _jump(20)),
    own("ieee1547-cat-ii", 0.0, 0.5, _jump(15)),
    own("spain-q-curve", 0.0, 0.4, _jump(180)),
    own("nerc-prc-029", 0.0, 0.5, _swell(1.18)),
    own("iec61400-21", 0.0, 0.4, _swell(2.0)),
    own("ieee1547-cat-ii", 0.0, 1.0, LEVELS),
    own("es-nts-631-lt110kv", 0.7, 0.4, two_phase=True, phases="bc", irradiance_w_m2=300.0),
    own("dk-rfg-dk2", 0.7, 0.4, two_phase=True, phases="ca"),
    own("iec61400-21", 0.4, 0.6, SHADE),
    own("es-nts-631-ge110kv", 0.8, 0.3, phases="a"),
    own("spain-q-curve", 0.6, 0.3, type="D"),
    own("ieee1547-cat-iii", 0.3, 0.3, FIFTH),
    own("es-nts-631-lt110kv", 0.6, 1.2),
    Case("iec61400-21", "VD6-full-1"),
    Case("es-po-12.3", "PVVC-4-2"),
    Case("es-nts-631-ge110kv", "U75TPmedQmax-1"),
    Case("es-nts-631-ge110kv", "U0BPmed-1"),
    Case("ieee1547-cat-ii", "0.460pu-0.32s-bc"),
    Case("ieee1547-cat-ii", "steady-full"),
    Case("ieee1547-cat-iii", "0.010pu-1s-a"),
    Case("nerc-prc-029", "0.105pu-0.32s-full"),
    Case("dk-rfg", "double-2ph-partial"),
    Case("dk-rfg", "phase-jump-extreme-30"),
    Case("dk-rfg-lt110kv", "1ph-0.40-full"),
    Case("rey-boue-500kva", "fig13-50hz"),
)


class Run(NamedTuple):
    """What the tool made of a case."""

    profile: Profile
    test: TestCase
    result: TestResult
    waveforms: Waveforms


def test_of(case: Case, profile: Profile) -> TestCase:
    """The test that a case names."""
    if case.row:
        return next(test for test in profile.tests() if test.id == case.row)
    return profile.ad_hoc_test(Sag(**case.sag), case.duration_s, **case.fields)


test_of.__test__ = False  # type: ignore[attr-defined] - not a test, whatever pytest thinks of the name


def run(case: Case) -> Run:
    """Simulate and judge a case."""
    profile = load_profile(case.profile)
    test = test_of(case, profile)
    judged = run_test(profile, test, Parameters())
    assert judged.waveforms is not None, judged.result.checks
    return Run(profile, test, judged.result, judged.waveforms)


def written(found: Run, folder: Path) -> Path:
    """The waveforms as a CSV file."""
    path = folder / "waveforms.csv"
    write_csv(found.waveforms, path)
    return path
