"""Why the binary of an FMU cannot be loaded: what it is, or which functions it lacks."""

import ctypes
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.library.besides import further_missing
from pvlvrt_compliance.controllers.library.file import check_format

_MOST_NAMED = 12


def why_not(error: Exception, binary: Path, kind: Any) -> str:
    """Why a binary cannot be loaded, as far as it can be told, else the words of the system.

    Parameters
    ----------
    error : Exception
        Of who has tried.
    binary : Path
    kind : class
        Of the library for FMUs; its methods are the functions that a binary must have.
    """
    content = b""
    try:
        content = binary.read_bytes()
        check_format(binary.name, content)
        loaded = ctypes.CDLL(str(binary))
    except DoorError as found:
        return str(found)
    except OSError as found:
        return str(found).replace(str(binary), binary.name) + further_missing(content, str(found))
    missing = [name for name in dir(kind) if name.startswith("fmi") and not hasattr(loaded, name)]
    if not missing:
        return str(error)
    more = f" and {len(missing) - _MOST_NAMED} more" if len(missing) > _MOST_NAMED else ""
    return f"{binary.name} has no function {', '.join(missing[:_MOST_NAMED])}{more}"
