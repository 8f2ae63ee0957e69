"""The profile that was judged against, as a report shows it."""

import datetime

from pydantic import BaseModel, ConfigDict, Field

from pvlvrt_compliance.texts import Id, Name, Text


class _Frozen(BaseModel):
    # Whoever reads a result of a later version goes by the keys that he knows; a file of a profile is held to its keys.
    model_config = ConfigDict(frozen=True, extra="ignore")


class AppliesToSummary(_Frozen):
    """Which plants the text is for, in its own terms."""

    plant: Name = ""
    power: Name = ""
    voltage: Name = ""


class NotCoveredSummary(_Frozen):
    """Something that the text demands and the profile does not judge."""

    what: Text
    clause: Name = ""
    why: Text


class ClauseSummary(_Frozen):
    """A clause that the profile knows, and what of the profile is of it."""

    clause: Name
    checks: tuple[Name, ...] = Field(default=(), description="kinds whose requirement has it as its own clause")
    parts: tuple[Text, ...] = Field(
        default=(), description="parts of requirements that have it: ride_through.envelope_over_voltage"
    )
    tests: tuple[Name, ...] = Field(
        default=(), description="ids of the profile's tests whose procedure it is, run or not"
    )
    judged_tests: int = Field(default=0, description="how many of the profile's tests are judged by these kinds")
    judged_long: int = Field(default=0, description="how many of those run on request only")
    confidence: Name = Field(default="", description="the weakest mark of what is of it")


class ProfileSummary(_Frozen):
    """The profile that was judged against, as a report shows it."""

    id: Id
    title: Name
    digest: Name
    edition: Name = Field(default="", description="of the text")
    jurisdiction: Name = Field(default="", description="where it is in force")
    applies_to: AppliesToSummary = AppliesToSummary()
    address: Name = Field(default="", description="where the text can be found")
    read_on: datetime.date | None = Field(default=None, description="when the text was read for the profile")
    not_covered: tuple[NotCoveredSummary, ...] = Field(
        default=(), description="what the text demands and the profile does not judge"
    )
    clauses: tuple[ClauseSummary, ...] = Field(default=(), description="every clause that the profile knows")
    notes: tuple[Text, ...] = Field(default=(), description="what is not verified, a sentence each")
    left_out: tuple[Name, ...] = Field(default=(), description="long tests that were not asked for, by id")
    selected_checks: tuple[Name, ...] = Field(
        default=(), description="kinds that were judged, where only some were asked for; none: all of the profile"
    )
    not_selected: tuple[Name, ...] = Field(
        default=(), description="ids of the profile's tests that the selection leaves out"
    )
    not_run: tuple[Name, ...] = Field(
        default=(), description="ids of selected tests that were not run, since the run ended before them"
    )
