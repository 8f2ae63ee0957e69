"""What a profile says of the text that it is made from, and of what that text has and the profile has not."""

import datetime

from pydantic import Field

from pvlvrt_compliance.data.marks import Frozen


class AppliesTo(Frozen):
    """Which plants the text is for, in its own terms."""

    plant: str = Field(default="", description="kind of plant: PV plants, power park modules of types B and C")
    power: str = Field(default="", description="range of its rated power: 0.1 to 50 MW")
    voltage: str = Field(default="", description="voltage of its connection: below 110 kV")


class NotCovered(Frozen):
    """Something that the text demands and the profile does not judge."""

    what: str = Field(min_length=1, description="what is demanded, in a few words; tells the entries apart")
    clause: str = Field(default="", description="where the text has it")
    why: str = Field(min_length=1, description="why the profile does not judge it")


class Head(Frozen):
    """The head of a profile: the text it is made from. Included files do not count for it, but for `not_covered`."""

    edition: str = Field(default="", description="edition of the text: v2.0 (November 2020)")
    jurisdiction: str = Field(default="", description="where it is in force: Spain")
    applies_to: AppliesTo = Field(default=AppliesTo(), description="which plants it is for")
    address: str = Field(default="", pattern="^$|^https?://", description="where the text can be found")
    read_on: datetime.date | None = Field(default=None, description="when the text was read for this profile")
    not_covered: tuple[NotCovered, ...] = Field(
        default=(),
        description="what the text demands and the profile does not judge; those of included files count, too",
    )
