"""The logo of whoever files a report: read once, when the run is asked for, and kept as a data: address."""

import base64
import re
from pathlib import Path

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of

LARGEST_BYTES = 1_000_000
ALLOWED = "a PNG, JPEG or SVG file of at most 1 MB"

_STARTS = {"png": b"\x89PNG\r\n\x1a\n", "jpeg": b"\xff\xd8\xff"}
_SVG = "{http://www.w3.org/2000/svg}svg"
_ADDRESS = re.compile(r"data:image/(png|jpeg|svg)(?:\+xml)?;base64,([A-Za-z0-9+/=]*)")


def logo_address(name: str, spelled: str) -> str:
    """Read a logo.

    Parameters
    ----------
    name : str
        Of its file.
    spelled : str
        What begins a message about it.

    Returns
    -------
    str
        Its content as ``data:image/png;base64,...``, of the kind that it has, whatever its name says.

    Raises
    ------
    UsageError
        When it cannot be read, or is none of what is `ALLOWED`.
    """
    try:
        content = content_of(Path(name), LARGEST_BYTES)
    except TooLargeError:
        raise UsageError(f"{spelled}: {name}: larger than 1 MB; a logo is {ALLOWED}") from None
    except NotOrdinaryError as error:
        raise UsageError(f"{spelled}: {name}: {error}; a logo is {ALLOWED}") from None
    kind = _kind(content)
    if kind is None:
        raise UsageError(f"{spelled}: {name}: no picture of a kind that is known; a logo is {ALLOWED}")
    mime = "svg+xml" if kind == "svg" else kind
    return f"data:image/{mime};base64,{base64.b64encode(content).decode('ascii')}"


def logo_content(address: str) -> tuple[str, bytes] | None:
    """Kind (``png``, ``jpeg``, ``svg``) and content of a logo; None where an address is not of one."""
    found = _ADDRESS.fullmatch(address)
    if found is None:
        return None
    try:
        return found[1], base64.b64decode(found[2], validate=True)
    except ValueError:
        return None


def _kind(content: bytes) -> str | None:
    for kind, start in _STARTS.items():
        if content.startswith(start):
            return kind
    return "svg" if _is_svg(content) else None


def _is_svg(content: bytes) -> bool:
    """Whether it is an SVG without a document type, in which one could define entities without end."""
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content or b"<svg" not in content:
        return False
    from xml.etree import ElementTree

    try:
        return ElementTree.fromstring(content).tag == _SVG
    except (ElementTree.ParseError, ValueError, LookupError):
        return False
