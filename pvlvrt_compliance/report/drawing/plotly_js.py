"""Plotly's JavaScript, and data for it, as they stand in a page."""

import json
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pvlvrt_compliance.errors import PvlvrtError


@cache
def plotly_js() -> str:
    """Plotly's JavaScript, read from the installed package without importing it (0.3 s).

    Raises
    ------
    PvlvrtError
        When it is missing from the installation.
    """
    spec = find_spec("plotly")
    for place in (spec.submodule_search_locations or []) if spec else []:
        file = Path(place) / "package_data" / "plotly.min.js"
        if file.is_file():
            return file.read_text(encoding="utf-8").replace("</script", "<\\/script")
    raise PvlvrtError("plotly's JavaScript is missing from the installation; install plotly again")


def as_script(data: Any) -> str:
    """Data as JSON that can stand in a script element: without "<" there is nothing to end it."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
