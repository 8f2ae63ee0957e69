"""The title page: what the document is, of what, how it ended, and who stands for it."""

from typing import Any

from pvlvrt_compliance.report.document.front import Fact, Front
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.logo import logo_content
from pvlvrt_compliance.report.pdf.characters import shown
from pvlvrt_compliance.report.pdf.compiling import can_be_shown
from pvlvrt_compliance.results import Results

_SIGNING = ("author", "approval")


def cover(results: Results, first: Front, texts: Texts) -> dict[str, Any]:
    """The title page as data for its template."""
    logo = _logo(first.logo, texts)
    lines = [_counts(results, texts), *first.on_the_run]
    subtitles = [texts("pdf.judged_against", codes="; ".join(code.title for code in first.against))]
    notes = [texts("pdf.note", scope=texts("pdf.scope"))]
    if first.logo and logo is None:
        notes.append(texts("pdf.no_logo"))
    return {
        "kind": shown(texts("front.kind")),
        "title": shown(title(results, texts)),
        "subtitles": [shown(line) for line in subtitles if first.against],
        "logo": logo,
        "verdict": {
            "status": results.status,
            "text": shown(texts.named("status", results.status).upper()),
            "lines": [shown(line) for line in lines if line],
        },
        "groups": [
            _group(texts("front.tested"), first.tested),
            _group(texts("front.document"), (*first.document, *_of_the_run(results, texts))),
        ],
        "signatures": _signatures(results.report.fields, texts),
        "note": shown(" ".join(notes)),
    }


def title(results: Results, texts: Texts) -> str:
    """What stands largest: the object of the report, or the kind of document where none was named."""
    return results.report.fields.get("object") or texts("front.kind")


def number(results: Results, texts: Texts) -> str:
    """Number and revision of the document; the run that it is of where it has none."""
    fields = results.report.fields
    if not fields.get("number"):
        return texts("pdf.number_of_run", run=results.run_id)
    if not fields.get("revision"):
        return fields["number"]
    return texts("pdf.number_and_revision", number=fields["number"], revision=fields["revision"])


def _counts(results: Results, texts: Texts) -> str:
    found = [
        texts("pdf.counted", count=count, verdict=texts.named("status", status))
        for status, count in results.counts().items()
    ]
    marginal = sum(finding.verdict.is_marginal for finding in results.verdicts())
    key = "pdf.counts_marginal" if marginal else "pdf.counts"
    counted = texts(key, counts=", ".join(found), count=marginal) if found else texts("front.no_check")
    return f"{texts('front.tests', count=len(results.tests))} {counted}"


def _of_the_run(results: Results, texts: Texts) -> tuple[Fact, ...]:
    created = results.provenance.get("created", "")
    facts = (Fact(texts("front.created"), created), Fact(texts("front.run"), results.run_id))
    return tuple(fact for fact in facts if fact.text)


def _group(heading: str, facts: tuple[Fact, ...]) -> dict[str, Any]:
    rows = [[shown(name), shown(text)] for name, text in facts]
    return {"title": shown(heading), "rows": rows, "code": False}


def _signatures(fields: dict[str, str], texts: Texts) -> dict[str, Any]:
    """A row for each of those who stand for the document, named or not, with room for date and signature."""
    heads = [shown(texts(f"pdf.{name}")) for name in ("role", "name", "date", "signature")]
    rows = [[shown(texts(f"pdf.{role}")), shown(fields.get(role, "")), "", ""] for role in _SIGNING]
    return {"heads": heads, "rows": rows}


def _logo(address: str, texts: Texts) -> dict[str, Any] | None:
    """The logo as kind and content; None where there is none, or typst cannot read it or may not keep it."""
    found = logo_content(address)
    if found is None:
        return None
    kind, content = found
    logo = {"kind": kind, "content": list(content), "alternative": texts("pdf.logo")}
    return logo if can_be_shown(logo) else None
