"""`gl-code-quality-report.json`, which GitLab shows beside a merge request: what fails, is known, or was left aside."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.gate import STOPS, Told, numbers_in_words, of_a_part, of_the_run, place_of, told
from pvlvrt_compliance.results import Results, Status
from pvlvrt_compliance.results.files import QUALITY_GITLAB

FILE = QUALITY_GITLAB
ASKED_FOR = True

_KNOWN, _WORSE = "info", "major"
_SEVERITY = {
    Status.ERROR: "blocker",
    Status.NOT_EVALUATED: "major",
    Status.FAIL: "critical",
    Status.NOT_APPLICABLE: _KNOWN,
}
_DIGITS = 32


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> str:  # noqa: ARG001
    """Return what GitLab calls degradations, as JSON.

    The fingerprint of one is of profile, test and check alone: with other numbers it is the same one, so that a merge
    request shows what is new and what is gone.
    """
    found = told(results)
    shown = [each for each in found if each.outcome in STOPS or each.verdict.is_known]
    if nothing := of_the_run(results, found):
        shown.append(nothing)
    if part := of_a_part(results):
        shown.append(part)
    return json.dumps([_degradation(each, results) for each in shown], indent=2, ensure_ascii=False) + "\n"


def _degradation(each: Told, results: Results) -> dict[str, Any]:
    said = "; ".join(filter(None, [each.reason, numbers_in_words(each.verdict)]))
    profile = each.test.profile or (results.profiles[0].id if results.profiles else each.test.id)
    return {
        "description": f"{each.test.key} {each.name}: {said}",
        "check_name": each.verdict.check,
        "fingerprint": _fingerprint(each),
        "severity": _severity(each),
        "location": {"path": place_of(each.test, results) or profile, "lines": {"begin": 1}},
        "run_id": results.run_id,
    }


def _severity(each: Told) -> str:
    if each.verdict.is_known:
        return _KNOWN
    return _SEVERITY.get(each.verdict.status, _WORSE)


def _fingerprint(each: Told) -> str:
    named = "\0".join((each.test.profile, each.test.id, each.name))
    return hashlib.sha256(named.encode("utf-8", "surrogatepass")).hexdigest()[:_DIGITS]
