"""What a check is: a class that judges one kind of requirement in the records of any test."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pvlvrt_compliance.measure.extremes import first_least
from pvlvrt_compliance.profile.requirements.base import Requirement
from pvlvrt_compliance.results import Drawn, Status, TestResult, Verdict

if TYPE_CHECKING:
    from pvlvrt_compliance.disturbance.model import Stretch
    from pvlvrt_compliance.evidence.evidence import Evidence

Scope = Literal["record", "stretch", "row"]
"""What is judged: a record as a whole, each stretch between two steps of the voltage, or all runs of a row."""


class Check(ABC):
    """Judges one kind of requirement; its docstring says in a sentence what it judges.

    A class attribute each: ``kind``, its name everywhere (profile key, JSON, JUnit); ``title``, for people;
    ``requirement``, its data model; ``judges_connection``, whether it says if the inverter may stop;
    ``judges_up_to_trip``, whether it looks at what was before a trip, where others have nothing to say. ``scope`` is
    that of the class it derives from: this one judges a record as a whole, `StretchCheck` each stretch, `RowCheck` all
    runs of a row. Nothing else in the program knows a check by name.
    """

    kind: ClassVar[str]
    title: ClassVar[str]
    requirement: ClassVar[type[Requirement]]
    scope: ClassVar[Scope] = "record"
    judges_connection: ClassVar[bool] = False
    judges_up_to_trip: ClassVar[bool] = False

    @abstractmethod
    def judge(self, requirement: Any, evidence: "Evidence") -> Verdict:
        """Judge a record.

        Parameters
        ----------
        requirement : Requirement
            Of the type that ``requirement`` names, as the profile has it.
        evidence : Evidence
            The record; its series and windows.

        Raises
        ------
        NotApplicable
            When the code lets the inverter off; the text is the reason.
        MeasurementError
            When evidence is missing: `not_evaluated`.
        """

    def released_at_s(self, requirement: Any, evidence: "Evidence") -> float | None:  # noqa: ARG002
        """When the requirement lets the inverter go (s), for checks that judge the connection; None: it never does.

        Raises
        ------
        MeasurementError
            When the record does not show it.
        """
        return None

    def limits(self, requirement: Any, evidence: "Evidence") -> tuple[Drawn, ...]:  # noqa: ARG002
        """What a figure draws of the requirement, in a record that it was judged in.

        Limits over time (`Band`), by order (`Spectrum`) or over another quantity (`Characteristic`), and when what a
        time is demanded of has come (`Instant`).
        """
        return ()


class StretchCheck(Check):
    """Judges each stretch between two steps of what the grid does; the worst verdict is reported and names its stretch.

    ``until`` says what ends it: support is due up to the release, limits hold up to the trip.
    """

    scope = "stretch"
    judges_up_to_trip = True
    until: ClassVar[Literal["trip", "release"]] = "release"

    @abstractmethod
    def judge_stretch(self, requirement: Any, evidence: "Evidence", stretch: "Stretch") -> Verdict:
        """Judge one stretch; parameters and errors as `judge`. One that is let off leaves the others judged."""

    def stretches(self, requirement: Any, evidence: "Evidence") -> "Sequence[Stretch]":  # noqa: ARG002
        """The stretches that the requirement concerns: by default those before the voltage stays where it ends up."""
        return evidence.disturbed_until(self.until)

    def judge(self, requirement: Any, evidence: "Evidence") -> Verdict:
        """Judge all stretches that the requirement concerns.

        Raises
        ------
        NotApplicable
            When there is none, or each is let off; then with the reason of the first.
        MeasurementError
            When nothing failed and one stretch cannot be measured.
        """
        from pvlvrt_compliance.errors import MeasurementError
        from pvlvrt_compliance.evidence.evidence import NotApplicable
        from pvlvrt_compliance.evidence.stretches import name_of

        stretches = self.stretches(requirement, evidence)
        verdicts: list[Verdict] = []
        reasons: list[NotApplicable] = []
        missing: list[MeasurementError] = []
        for stretch in stretches:
            try:
                verdict = self.judge_stretch(requirement, evidence, stretch)
            except NotApplicable as reason:
                reasons.append(reason)
            except MeasurementError as error:
                missing.append(error)
            else:
                name = name_of(stretch, evidence) if len(stretches) > 1 else ""
                text = f"{name}: {verdict.message}" if name else verdict.message
                verdicts.append(verdict.model_copy(update={"stretch": name, "message": text}))
        try:
            if missing and not any(verdict.status is Status.FAIL for verdict in verdicts):
                raise missing[0]
            if verdicts:
                return decisive(verdicts)
            raise reasons[0] if reasons else NotApplicable("nothing in this test is what this requirement speaks of")
        finally:  # an error that its own frame holds keeps the record until somebody looks for circles
            missing.clear()
            reasons.clear()


class RowCheck(Check):
    """Judges all runs of a row of the test table together."""

    scope = "row"

    def judge(self, requirement: Any, evidence: "Evidence") -> Verdict:
        """A row is judged by its results, never by one record."""
        raise NotImplementedError(f"{self.kind} judges rows")

    @abstractmethod
    def further_runs_wanted(
        self, requirement: Any, runs: Sequence[TestResult], further: Sequence[TestResult] = ()
    ) -> int:
        """How many more runs the rule asks for before it can be judged.

        Parameters
        ----------
        runs : sequence of TestResult
            The row's own, in order.
        further : sequence of TestResult
            Those that were asked for since.
        """

    @abstractmethod
    def judge_row(self, requirement: Any, runs: Sequence[TestResult], further: Sequence[TestResult] = ()) -> Verdict:
        """Judge the row by the results of its runs."""


_WORST_FIRST = list(Status)


def decisive(verdicts: Sequence[Verdict]) -> Verdict:
    """The worst of some verdicts; of several that are equally bad the one with the least margin, then the first.

    One that failed without a margin (connection was demanded throughout) is worse than any that has one.
    """

    def margin(verdict: Verdict) -> float:
        without = -math.inf if verdict.status is Status.FAIL else math.inf
        return without if verdict.margin is None else verdict.margin

    worst = min((verdict.status for verdict in verdicts), key=_WORST_FIRST.index)
    return nearest([verdict for verdict in verdicts if verdict.status is worst], margin)


def nearest(verdicts: Sequence[Verdict], margin: Callable[[Verdict], float]) -> Verdict:
    """The first of some verdicts whose margin is the least within rounding, which is a part of their limits' size."""
    return first_least(verdicts, margin, max(abs(verdict.limit or 0.0) for verdict in verdicts))
