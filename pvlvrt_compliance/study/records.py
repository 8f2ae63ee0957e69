"""Waveform files of a run, written as its records come, so that no record need be kept."""

from datetime import datetime
from pathlib import Path

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import UNSETTLED, TestResult
from pvlvrt_compliance.results.files import WAVEFORMS
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.job import KEEP_ALL, KEEP_FAILED, Job
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.store import OutputFolder
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.csv import write_csv


class Records:
    """Files in the output folder, one record for all tests of its scenario.

    Parameters
    ----------
    output : OutputFolder
        Where they are staged.
    job : Job
        Says which are kept.
    created : datetime
        Instant of t = 0.
    csv : bool
        Whether they are written as CSV, too.
    """

    def __init__(self, output: OutputFolder, job: Job, created: datetime, *, csv: bool = False) -> None:
        self._output = output
        self._job = job
        self._created = created
        self._csv = csv
        self._names: dict[Scenario, str] = {}

    @property
    def names(self) -> set[str]:
        """Names of those that are written."""
        return set(self._names.values())

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
            self._write(item, evidence, self._output.waveforms / name)
            self._names[scenario] = name
        return self._names[scenario]

    def _write(self, item: Assignment, evidence: Evidence, stem: Path) -> None:
        waveforms = evidence.waveforms.with_settling
        with self._output.writing(stem.with_name(f"{stem.name}.dat")):
            write_comtrade(
                waveforms,
                stem,
                station=item.profile.id,
                device="pvlvrt-check",
                frequency_hz=evidence.nominal.frequency_hz,
                start=self._created,
                trigger_s=item.test.scenario.start_s,
            )
        if self._csv:
            table = stem.with_name(f"{stem.name}.csv")
            with self._output.writing(table):
                write_csv(waveforms, table)
