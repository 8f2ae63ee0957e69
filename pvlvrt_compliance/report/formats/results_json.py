"""`results.json` and its published schema."""

import json
from collections.abc import Mapping

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import RESULTS

FILE = RESULTS

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> str:  # noqa: ARG001
    """Return the results as JSON, keys in the order of the model, indented by two, with a final newline."""
    return results.model_dump_json(indent=2) + "\n"


def schema() -> str:
    """Return the JSON Schema (draft 2020-12) of `results.json`."""
    return json.dumps({"$schema": _DIALECT, **Results.model_json_schema()}, indent=2, ensure_ascii=False) + "\n"
