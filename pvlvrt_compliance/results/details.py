"""What whoever files a report gives for it: the language, and the fields of its title page."""

from typing import Final

from pydantic import BaseModel, ConfigDict, Field

FIELDS: Final = (
    "client", "object", "manufacturer", "type", "serial", "firmware", "commit",
    "number", "revision", "author", "approval", "logo", "remark",
)  # fmt: skip
"""Fields of a title page, in its order: of what was tested, then of the document."""

LOGO: Final = "logo"
"""Is given as the name of a file, and kept as its content."""

IDENTITY: Final = ("object", "manufacturer", "type", "serial", "firmware", "commit")
"""Those that say what was tested."""


class ReportDetails(BaseModel):
    """What is given for a report besides what was run; it decides nothing that was found."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    language: str = "en"
    fields: dict[str, str] = Field(default_factory=dict, description="by name; a logo is a data: address")
