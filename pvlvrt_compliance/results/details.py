"""What whoever files a report gives for it: the language, and the fields of its title page."""

import re
from typing import Annotated, Final

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from pvlvrt_compliance.texts import Name, one_line, printable

FIELDS: Final = (
    "client", "object", "manufacturer", "type", "serial", "firmware", "commit",
    "number", "revision", "author", "approval", "logo", "remark",
)  # fmt: skip
"""Fields of a title page, in its order: of what was tested, then of the document."""

LOGO: Final = "logo"
"""Is given as the name of a file, and kept as its content."""

IDENTITY: Final = ("object", "manufacturer", "type", "serial", "firmware", "commit")
"""Those that say what was tested."""


_ADDRESS: Final = re.compile(r"data:image/[a-z+]+;base64,[A-Za-z0-9+/=]*")


def _shown(fields: dict[str, str]) -> dict[str, str]:
    """Fields that anybody may be shown; the address of a logo, which has no other characters, is of any length."""
    return {
        one_line(name): value if name == LOGO and _ADDRESS.fullmatch(value) else printable(value)
        for name, value in fields.items()
    }


class ReportDetails(BaseModel):
    """What is given for a report besides what was run; it decides nothing that was found."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    language: Name = "en"
    fields: Annotated[dict[str, str], AfterValidator(_shown)] = Field(
        default_factory=dict, description="by name; a logo is a data: address"
    )
