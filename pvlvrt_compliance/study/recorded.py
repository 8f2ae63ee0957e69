"""Judging a record that is there already, simulated or measured."""

import hashlib
from pathlib import Path
from typing import Any

from pvlvrt_compliance.checks.evaluate import evidence_of, judge_record
from pvlvrt_compliance.checks.summary import summarise
from pvlvrt_compliance.disturbance.found import Thresholds, disturbance_found
from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.evidence.collect import normal_voltage
from pvlvrt_compliance.ordinary_file import content_of
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import Results, conclude
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.provenance import created_at, provenance_of_record
from pvlvrt_compliance.study.timing import Stopwatch
from pvlvrt_compliance.units import Nominal, nearest_nominal_frequency
from pvlvrt_compliance.waveforms import Waveforms
from pvlvrt_compliance.waveforms.recording import LARGEST_RECORD_BYTES, files_of, read_waveforms

_NO_FILE = "record"


def judge_recording(
    profile: Profile,
    record: str | Waveforms,
    *,
    test: str | Scenario | None = None,
    nominal: Nominal | None = None,
    available_power_kw: float | None = None,
) -> Results:
    """Judge a record by every requirement of a profile.

    Parameters
    ----------
    profile : Profile
        What is demanded.
    record : str or Waveforms
        A file (CSV or COMTRADE), or what was read from one.
    test : str or Scenario, optional
        Id of the profile's test that was applied, or what was asked for; without, it is found in the record.
    nominal : Nominal, optional
        Base of the per-unit values; by default 500 kVA, 230 V, and the frequency of the profile.
    available_power_kw : float, optional
        What the array could give before the disturbance; by default the rated power.

    Raises
    ------
    UsageError
        When the record cannot be read, or the profile has no such test.
    MeasurementError
        Without a test: when the record has no voltages, or nothing happens in it.
    """
    watch = Stopwatch()
    waveforms = read_waveforms(Path(record)) if isinstance(record, str) else record
    name = Path(record).stem if isinstance(record, str) else _NO_FILE
    nominal = nominal or Nominal(frequency_hz=_frequency_hz(profile))
    available_w = nominal.apparent_power_va if available_power_kw is None else 1e3 * available_power_kw
    disturbance: Disturbance | None = None
    if test is None:
        thresholds = Thresholds(normal_voltage(profile.thresholds))
        disturbance = disturbance_found(waveforms, nominal, thresholds)
        case = _case(name, disturbance.in_words, _stand_in())
    else:
        case = _case(name, test.describe(), test) if isinstance(test, Scenario) else _test_of(profile, test)
    result = judge_record(profile, case, evidence_of(profile, case, waveforms, nominal, available_w, disturbance))
    if test is None:
        result = result.model_copy(update={"scenario": {}})  # nobody has asked for one
    result = result.model_copy(update={"wall_time_s": watch.elapsed_s})
    created = created_at()
    return conclude([result], [summarise(profile, [case])], provenance_of_record(profile, _origin(record), created))


def _frequency_hz(profile: Profile) -> float:
    stated = profile.procedure.frequency_hz
    return nearest_nominal_frequency(50.0 if stated is None else stated.value)


def _stand_in() -> Scenario:
    """In the place of a scenario that nobody has asked for: the disturbance that is found goes before it."""
    return Scenario(sag=Sag(depth=0.0), duration_s=1.0)


def _case(name: str, title: str, scenario: Scenario) -> TestCase:
    return TestCase(id=name, title=title, scenario=scenario)


def _test_of(profile: Profile, name: str) -> TestCase:
    cases = {case.id.lower(): case for case in profile.tests()}
    if name.lower() not in cases:
        ids = [case.id for case in cases.values()]
        hint = did_you_mean(name, ids) or (f"; it has {ids[0]} to {ids[-1]}" if ids else "; it has none")
        raise UsageError(f"test {name}: {profile.id} has no test of this name{hint}")
    return cases[name.lower()]


def _origin(record: str | Waveforms) -> dict[str, Any]:
    """What identifies a record."""
    if isinstance(record, Waveforms):
        digest = hashlib.sha256()
        for segment in record:
            digest.update(repr((segment.t0_s, segment.dt_s, *segment.channels)).encode())
            for samples in segment.channels.values():
                digest.update(samples.tobytes())
        return {"record": _NO_FILE, "record_digest": digest.hexdigest()}
    content = b"".join(content_of(file, LARGEST_RECORD_BYTES) for file in files_of(Path(record)))
    return {"record": record, "record_digest": hashlib.sha256(content).hexdigest()}
