"""What a run has found, as one result object."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.checks.summary import summarise
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import ProfileSummary, ReportDetails, Results, conclude
from pvlvrt_compliance.study.baseline.applying import held_against
from pvlvrt_compliance.study.baseline.catalogue import Catalogue
from pvlvrt_compliance.study.ordering import in_order
from pvlvrt_compliance.study.provenance import bundled, provenance
from pvlvrt_compliance.study.reuse.telling import reuse_of
from pvlvrt_compliance.study.selection import Assignment, kinds_judged
from pvlvrt_compliance.study.work import Tested, Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator


@dataclass(frozen=True, kw_only=True)
class Account:
    """What is known of a run besides its tests: with those that are finished, its results.

    Parameters
    ----------
    work : Work
        What is run.
    controller : ForeignSimulator, optional
        The job's own, opened.
    command : sequence of str or str
        What makes the run again: words of a command line, or a text.
    settings : mapping, optional
        What was written down in a file or the environment.
    created : datetime
        When the run began.
    details : ReportDetails, optional
        What is given for the reports.
    files : mapping
        Where the user's files are in a repository, as `repository.files_of` gives them.
    """

    work: Work
    controller: "ForeignSimulator | None"
    command: Sequence[str] | str
    settings: Mapping[str, Any] | None
    created: datetime
    details: ReportDetails | None
    files: Mapping[str, Any]

    def load(self) -> None:
        """Load what the results will name; afterwards it costs nothing."""
        if self.controller is None:
            bundled()

    def results(self, tests: Sequence[Tested], *, interrupted: bool = False) -> Results:
        """The results of finished tests, in the order of the profiles.

        Parameters
        ----------
        tests : sequence of Tested
            In the order in which they were finished.
        interrupted : bool
            Whether the run has ended early.
        """
        job = self.work.job
        finished = in_order(tests, job)
        own = self.controller.provenance(job.parameters) if self.controller else {}
        origin = provenance(
            *(job.profiles, job.parameters, self.command, self.created, own, self.files, self.settings),
            reuse=reuse_of(job, finished),
        )
        results = conclude(
            [tested.result for tested in finished],
            [self._summary(profile, {tested.result.key for tested in finished}) for profile in job.profiles],
            origin,
            allow_unjudged=self.work.allow_unjudged,
            report=self.details,
            ended_at=self._ended_at(tests),
            interrupted=interrupted,
        )
        if job.baseline is None:
            return results
        return held_against(results, job.baseline, Catalogue(job.profiles, [x.key for x in results.tests]).is_gone)

    def _summary(self, profile: Profile, run: Collection[str]) -> ProfileSummary:
        """A profile as the reports show it; ``run`` are the keys of what is finished."""
        job = self.work.job
        return summarise(
            profile,
            _of(profile, (item for item in job.tests if item.key in run)),
            left_out=_of(profile, job.left_out),
            not_selected=_of(profile, job.not_selected),
            not_run=_of(profile, (item for item in job.tests if item.key not in run)),
            selected_checks=kinds_judged(profile, job.checks),
        )

    def _ended_at(self, tests: Iterable[Tested]) -> str:
        """Key of the test that has ended the run; nothing where all are run, or something else has ended it."""
        if not self.work.job.fail_fast:
            return ""
        return next((tested.result.key for tested in tests if self.work.is_a_failure(tested.result)), "")


def _of(profile: Profile, items: Iterable[Assignment]) -> list[TestCase]:
    return [item.test for item in items if item.profile is profile]
