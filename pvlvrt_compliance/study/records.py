"""Waveform files of a run, written as its records come, so that no record need be kept."""

from contextlib import AbstractContextManager
from pathlib import Path

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import UNSETTLED, TestResult
from pvlvrt_compliance.results.files import WAVEFORMS
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.job import KEEP_ALL, KEEP_FAILED, Job
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.store import writing
from pvlvrt_compliance.study.work import Keeping
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.csv import write_csv


class Records:
    """Files in the output folder, one record for all tests of its scenario.

    Parameters
    ----------
    keeping : Keeping
        Where they are staged.
    job : Job
        Says which are kept.
    """

    def __init__(self, keeping: Keeping, job: Job) -> None:
        self._keeping = keeping
        self._job = job
        self._names: dict[Scenario, str] = {}

    def keep(self, item: Assignment, result: TestResult, evidence: Evidence) -> TestResult:
        """Write the record of a test, where it is to be kept; the result then says where it is.

        Raises
        ------
        OutputError
            When it cannot be written.
        """
        if not self._wants(result):
            return result
        return result.model_copy(update={"waveforms": f"{WAVEFORMS}/{self._name_of(item, result, evidence)}.cfg"})

    def _wants(self, result: TestResult) -> bool:
        kept = self._job.waveforms
        return kept == KEEP_ALL or (kept == KEEP_FAILED and result.status in UNSETTLED)

    def _name_of(self, item: Assignment, result: TestResult, evidence: Evidence) -> str:
        scenario = item.test.scenario
        if scenario not in self._names:
            name = result.key if len(self._job.profiles) > 1 else result.id
            self._write(item, evidence, self._keeping.staging / WAVEFORMS / name)
            self._names[scenario] = name
        return self._names[scenario]

    def _write(self, item: Assignment, evidence: Evidence, stem: Path) -> None:
        waveforms = evidence.waveforms.with_settling
        with self._writing(stem.with_name(f"{stem.name}.dat")):
            write_comtrade(
                waveforms,
                stem,
                station=item.profile.id,
                device="pvlvrt-check",
                frequency_hz=evidence.nominal.frequency_hz,
                start=self._keeping.created,
                trigger_s=item.test.scenario.start_s,
            )
        if self._keeping.csv:
            table = stem.with_name(f"{stem.name}.csv")
            with self._writing(table):
                write_csv(waveforms, table)

    def _writing(self, path: Path) -> AbstractContextManager[None]:
        return writing(path, self._keeping.staging, self._keeping.folder)
