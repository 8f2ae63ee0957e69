"""Reading the results of a run, of this version or an earlier one."""

from pathlib import Path

from pydantic import ValidationError

from pvlvrt_compliance.data.problems import dotted, problem_lines
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of
from pvlvrt_compliance.results.results import SCHEMA_VERSION, Results

LARGEST_BYTES = 256 << 20
"""Of results (chosen): those of all profiles that ship have some 10 MB."""


def read_results(path: Path) -> Results:
    """Read a `results.json`; keys that this version does not know are left aside.

    Raises
    ------
    UsageError
        When the file cannot be read, holds no results, or was written by a version that means other things by its keys.
    """
    try:
        content = content_of(path, LARGEST_BYTES)
    except TooLargeError:
        raise UsageError(
            f"{path}: larger than {LARGEST_BYTES >> 20} MiB; results of all profiles have some 10"
        ) from None
    except NotOrdinaryError as error:
        raise UsageError(f"{path}: {error}") from None
    try:
        results = Results.model_validate_json(content)
    except ValidationError as error:
        location, text = problem_lines(error, Results)[0]
        raise UsageError(f"{path}: no results of a run: {dotted(location) or 'the file'}: {text}") from None
    if results.schema_version > SCHEMA_VERSION:
        found = f"schema_version {results.schema_version} is of a later version"
        raise UsageError(f"{path}: {found}; this one reads up to {SCHEMA_VERSION}")
    return results
