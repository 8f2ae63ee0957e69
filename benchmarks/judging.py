"""Times judging beside simulating: in one process, on one core, without figures and files, in processor time."""

import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from row import Row

from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.run import run_test
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.waveforms import Waveforms

PROFILE = "es-nts-631-lt110kv"
_RECORD_S, _TESTS = 3.0, 30


class Spent(NamedTuple):
    """Processor time of one test (s)."""

    simulating: float
    judging: float


def rows(repeats: int) -> Iterator[Row]:
    """Rows of the table: each test of the profile once a repeat, and tests whose record is cut to 3 s."""
    job = make_job(Asked(profiles=(PROFILE,)))
    spent(job.tests[:1], job.parameters)  # everything is imported, compiled or read by then
    whole = [_sums(spent(job.tests, job.parameters)) for _ in range(repeats)]
    yield Row(
        f"judging a test of `{PROFILE}`, against simulating it",
        [judging / simulating for simulating, judging in whole],
        "x",
        must=1.0,
        stretch=0.5,
        reference=f"simulating its {len(job.tests)} tests, processor time",
        reference_values=[simulating for simulating, _ in whole],
    )
    short = [_of_3_s(item) for item in job.tests if item.test.scenario.end_s >= _RECORD_S][:_TESTS]
    timed = [_sums(spent(short, job.parameters)) for _ in range(repeats)]
    yield Row(
        f"judged tests of {_RECORD_S:g} s a second, one core, no figures, no files",
        [len(short) / (simulating + judging) for simulating, judging in timed],
        "1/s",
        must=15,
        stretch=30,
        is_at_least=True,
        reference="simulated tests of the same a second",
        reference_values=[len(short) / simulating for simulating, _ in timed],
        reference_unit="1/s",
    )


def spent(tests: Sequence[Assignment], parameters: Parameters) -> list[Spent]:
    """Processor time of each test, in this process with all its threads."""
    found = []
    for profile, test in tests:
        simulating = 0.0

        def timed(scenario: Scenario, of: Parameters) -> Waveforms:
            nonlocal simulating
            start = time.process_time()
            record = simulate(scenario, of)
            simulating = time.process_time() - start
            return record

        start = time.process_time()
        judged = run_test(profile, test, parameters, timed)
        if judged.evidence is not None:
            judged.evidence.forget()  # as a session does: else records stay in memory until they are looked for there
        del judged
        found.append(Spent(simulating, time.process_time() - start - simulating))
    return found


def _sums(times: Sequence[Spent]) -> Spent:
    return Spent(sum(x.simulating for x in times), sum(x.judging for x in times))


def _of_3_s(item: Assignment) -> Assignment:
    """A test whose record ends after 3 s."""
    scenario = item.test.scenario
    after_s = scenario.after_s - (scenario.end_s - _RECORD_S)
    if after_s <= 0:
        return item
    return item._replace(
        test=item.test.model_copy(update={"scenario": scenario.model_copy(update={"after_s": after_s})})
    )
