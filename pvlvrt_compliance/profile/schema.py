"""JSON Schema of a profile's file."""

from typing import Any

from pvlvrt_compliance.profile.profile import profile_of
from pvlvrt_compliance.profile.requirements import BUILT_IN, Kinds

_REQUIRED = ["schema_version", "id", "title"]


def file_schema(kinds: Kinds = BUILT_IN) -> dict[str, Any]:
    """JSON Schema of one file with these kinds of requirements, for editors.

    Only the head is required, since any other key may come from an include; that the profile is complete is for
    `load_profile` to say. Everything else is as strict as the data model: unknown keys, types and ranges of values.
    """
    schema = profile_of(kinds).model_json_schema(by_alias=True)
    for definition in schema["$defs"].values():
        definition.pop("required", None)
    schema["required"] = _REQUIRED
    texts = {"type": "array", "items": {"type": "string"}}
    schema["properties"] |= {
        "include": texts | {"description": "names or paths of profiles that this file builds on"},
        "drop_tests": texts | {"description": "shell patterns: ids of included tests to leave out"},
        "drop_not_covered": texts | {"description": "shell patterns: included entries of not_covered to leave out"},
    }
    schema["title"] = "Profile of a grid code"
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
