"""Reading the results of a run, of this version or an earlier one."""

from pathlib import Path

from pydantic import ValidationError

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.results.results import SCHEMA_VERSION, Results


def read_results(path: Path) -> Results:
    """Read a `results.json`; keys that this version does not know are left aside.

    Raises
    ------
    UsageError
        When the file cannot be read, holds no results, or was written by a version that means other things by its keys.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path}: cannot be read ({error.strerror or error})") from None
    try:
        results = Results.model_validate_json(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        raise UsageError(f"{path}: no results of a run: {where}: {first['msg']}") from None
    if results.schema_version > SCHEMA_VERSION:
        found = f"schema_version {results.schema_version} is of a later version"
        raise UsageError(f"{path}: {found}; this one reads up to {SCHEMA_VERSION}")
    return results
