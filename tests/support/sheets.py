"""Reports as PDF, read."""

import base64
import io

import pypdf

from pictures import png
from pvlvrt_compliance.results import ReportDetails, Results

A4 = (595.0, 842.0)

PNG = "data:image/png;base64," + base64.b64encode(png()).decode()

FIELDS = {
    "client": "Huerta Solar, S.A.",
    "object": "Inverter 4.2",
    "number": "R-17",
    "revision": "B",
    "author": "A. Ingeniera",
    "approval": "B. Jefa",
    "logo": PNG,
}


def with_fields(results: Results, language: str = "en", **fields: str) -> Results:
    """The same results with what whoever files them has given."""
    return results.model_copy(update={"report": ReportDetails(language=language, fields=fields)})


def read(content: bytes) -> pypdf.PdfReader:
    """A PDF, parsed."""
    return pypdf.PdfReader(io.BytesIO(content))


def words(page: pypdf.PageObject) -> str:
    """Its text, with one space where there are several."""
    return " ".join(page.extract_text().replace("\u200b", "").split())
