"""The whole document as data for the templates: title page, sections, annexes, and what stands on every sheet."""

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

from pvlvrt_compliance.report.document.front import front
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.annexes import annexes
from pvlvrt_compliance.report.pdf.blocks import as_data
from pvlvrt_compliance.report.pdf.characters import shown, told
from pvlvrt_compliance.report.pdf.codes import codes_section, coverage_section
from pvlvrt_compliance.report.pdf.cover import cover, number, title
from pvlvrt_compliance.report.pdf.found import results_section, summary_section
from pvlvrt_compliance.report.pdf.made import conditions_section, method_section, scope_section
from pvlvrt_compliance.report.pdf.tests import tests_section
from pvlvrt_compliance.results import Results

_UNKNOWN = datetime.fromtimestamp(0, UTC)
"""PDF/A wants a date; of results that do not tell theirs it is the first one that there is."""


def document(results: Results, drawings: Mapping[str, Drawing], texts: Texts) -> dict[str, Any]:
    """Everything that stands in the document, in the language of ``texts``."""
    first = front(results, texts)
    name = f"{texts('front.kind')}: {title(results, texts)}" if results.report.fields.get("object") else ""
    sections = (
        summary_section(results, first, texts),
        scope_section(results, texts),
        codes_section(results, texts),
        conditions_section(results, first, texts),
        method_section(results, texts),
        coverage_section(results, texts),
        results_section(results, texts),
        tests_section(results, drawings, texts),
        *annexes(results, texts),
    )
    return {
        "language": texts.language,
        "title": told(name or texts("front.kind")),
        "authors": [told(author) for author in (results.report.fields.get("author", ""),) if author],
        "description": told(texts("pdf.subject", run=results.run_id)),
        "keywords": [told(word) for word in (*(profile.id for profile in results.profiles), results.run_id)],
        "created": _moment(results),
        "header": {"title": shown(name or texts("front.kind")), "number": shown(number(results, texts))},
        "page": shown(texts("pdf.page", page="{page}", pages="{pages}")),
        "footer": shown(_footer(results, texts)),
        "cover": cover(results, first, texts),
        "contents": shown(texts("page.contents")),
        "sections": as_data(sections),
    }


def _footer(results: Results, texts: Texts) -> str:
    version = results.provenance.get("versions", {}).get("pvlvrt-compliance", "")
    created = str(results.provenance.get("created", ""))[:10]
    return texts("pdf.footer", version=version, run=results.run_id, created=created)


def _moment(results: Results) -> list[int]:
    """When the run was made, UTC, as year, month, day, hour, minute, second."""
    try:
        moment = datetime.fromisoformat(results.provenance["created"]).astimezone(UTC)
    except (KeyError, TypeError, ValueError):
        moment = _UNKNOWN
    return [*moment.timetuple()[:6]]
