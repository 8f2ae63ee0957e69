"""`report.md`: what fails the run, what is known, and the least margins, for a comment to a merge request."""

from collections.abc import Mapping

from pvlvrt_compliance.report.document.comment import comment
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import REPORT_MARKDOWN

FILE = REPORT_MARKDOWN
ASKED_FOR = True

ROOM = 65_536 - 1_536
"""Bytes, fewer than the characters that GitHub takes as a comment (65,536): whoever posts it may put a line before."""


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> str:  # noqa: ARG001
    """Return the results as a comment of at most `ROOM` bytes; texts in it are neither markup nor links."""
    return comment(results, ROOM)
