"""What holds, as plain data for whoever shows it."""

from typing import Any

from pvlvrt_compliance.settings.effective import Effective
from pvlvrt_compliance.settings.reading import Value


def told(holds: Effective) -> dict[str, Any]:
    """Every value that is not at its default, the file or why there is none, and what is told.

    A value is there with where it comes from; it is None where an empty one has taken it back to its default.
    """
    file = holds.found.file
    values = {
        setting.key: {"value": value.value, "from": value.origin} | _each(value)
        for name, setting in holds.settings.items()
        if (value := holds.values.get(name)) is not None
    }
    return {
        "file": None if file is None else file.source.origin,
        "why_not": holds.found.why_not or None,
        "values": values,
        "put_aside": list(holds.put_aside),
        "warnings": list(holds.warnings),
    }


def _each(value: Value) -> dict[str, Any]:
    """Where the items of a list come from, where they do not all stand in one line."""
    if not value.lines:
        return {}
    kept = set(value.value)  # a file may have as many items as fit into it
    origins = [line.rpartition(" ")[0] for item, line in value.lines.items() if item in kept]
    return {"each_from": origins} if set(origins) - {value.origin} else {}
