"""`report.pdf`: the report as it is filed and signed, on A4, PDF/A; needs the extra ``pdf`` (typst), no browser."""

from collections.abc import Mapping

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import REPORT_PDF

FILE = REPORT_PDF
ASKED_FOR = True
TAKES_A_WHILE = True
OF_WHOLE_RUNS = True
SHOWS = "drawing"


def needs() -> None:
    """See that typst is installed.

    Raises
    ------
    UsageError
        When it is not; names the extra.
    """
    from pvlvrt_compliance.report.pdf.compiling import check_installed

    check_installed()


def render(results: Results, drawings: Mapping[str, Drawing]) -> bytes:
    """Return the report as a PDF: of the same results and drawings the same bytes, on every machine.

    Parameters
    ----------
    results : Results
        In whose `report` the language and the fields of the title page are.
    drawings : mapping
        Drawings of tests, by their key; a test without one says so.

    Raises
    ------
    UsageError
        When typst is not installed.
    OutputError
        When it refuses what it is given.
    PvlvrtError
        When the templates are missing from the installation.
    """
    from pvlvrt_compliance.report.pdf.compiling import compiled  # a run without it loads none of this
    from pvlvrt_compliance.report.pdf.document import document

    return compiled(document(results, drawings, Texts(results.report.language)))
