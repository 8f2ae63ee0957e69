"""`results.json` and its published schema."""

import json

from pvlvrt_compliance.results import Results

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def render(results: Results) -> str:
    """Return the results as JSON, keys in the order of the model, indented by two, with a final newline."""
    return results.model_dump_json(indent=2) + "\n"


def schema() -> str:
    """Return the JSON Schema (draft 2020-12) of `results.json`."""
    return json.dumps({"$schema": _DIALECT, **Results.model_json_schema()}, indent=2, ensure_ascii=False) + "\n"
