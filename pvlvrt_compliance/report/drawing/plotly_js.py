"""Plotly's JavaScript, and data for it, as they stand in a page."""

import json
import zlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pvlvrt_compliance.cache import kept, named
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.report.drawing import packing


@cache
def plotly_js() -> str:
    """Plotly's JavaScript, as it may stand in a script element.

    Raises
    ------
    PvlvrtError
        When it is missing from the installation.
    """
    return plotly_file().read_text(encoding="utf-8").replace("</script", "<\\/script")


def plotly_packed() -> str:
    """Plotly's JavaScript, compressed, which `figures.js` runs once the first figure comes into view.

    Raises
    ------
    PvlvrtError
        When it is missing from the installation.
    """
    makers = [Path(file).read_bytes() for file in (__file__, packing.__file__)]
    name = named("plotly", plotly_file().read_bytes(), *makers, zlib.ZLIB_RUNTIME_VERSION)
    return kept(name, lambda: packing.compressed(plotly_js().encode()).encode("ascii")).decode("ascii")


def plotly_file() -> Path:
    """The file of plotly's JavaScript, found in the installed package without importing it (0.3 s).

    Raises
    ------
    PvlvrtError
        When it is missing from the installation.
    """
    spec = find_spec("plotly")
    for place in (spec.submodule_search_locations or []) if spec else []:
        file = Path(place) / "package_data" / "plotly.min.js"
        if file.is_file():
            return file
    raise PvlvrtError("plotly's JavaScript is missing from the installation; install plotly again")


def as_script(data: Any) -> str:
    """Data as JSON that can stand in a script element: without "<" there is nothing to end it."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
