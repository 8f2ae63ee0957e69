"""Figures of a page that come in a file, which anybody may have written: only what ours consist of is taken."""

import re
from functools import cache
from xml.parsers import expat

from markupsafe import Markup
from pydantic import TypeAdapter

from pvlvrt_compliance.report.drawing.in_page import Figure
from pvlvrt_compliance.report.drawing.looks import NAME, is_look
from pvlvrt_compliance.report.page.section import Section

_ELEMENTS = frozenset({"svg", "g", "path", "circle", "text", "tspan", "title"})
_PLACES = ("viewBox", "width", "height", "x", "y", "cx", "cy", "r", "d", "dy", "transform")
_LOOKS = (
    *("fill", "fill-opacity", "stroke", "stroke-dasharray", "stroke-opacity", "stroke-width"),
    *("font-size", "text-anchor", "class"),
)
_ATTRIBUTES = frozenset((*_PLACES, *_LOOKS))
_VALUE = re.compile(r"[A-Za-z0-9 .,()#-]*")  # no address, and no end of a declaration
_CLASS = re.compile(f"{NAME}|halo")


@cache
def _typed() -> TypeAdapter[Section]:
    return TypeAdapter(Section)


def checked(section: Section) -> Section:
    """A section without words whose pictures are markup of a page.

    Raises
    ------
    ValueError
        When its figures are anything but what `section_of` makes of a drawing.
    """
    made = _typed().validate_python(section).without_words()
    if wrong := [look for look in made.looks if not is_look(look)]:
        raise ValueError(f"a look of figures is {wrong[0][:40]!r}")
    if made.figures is None:
        return made
    each = tuple(map(_checked, made.figures.each))
    return made._replace(figures=made.figures._replace(each=each))


def _checked(figure: Figure) -> Figure:
    _read(figure.picture)
    return figure._replace(picture=Markup(figure.picture))


def _read(picture: str) -> None:
    """Read a picture as SVG: a script in it, an address, a comment or what only a browser understands is refused.

    Raises
    ------
    ValueError
        With what it has that a picture of ours has not.
    """
    if "<!" in picture or "<?" in picture:
        raise ValueError("a picture has more than elements and text")
    reader = expat.ParserCreate()
    reader.StartElementHandler = _take
    try:
        reader.Parse(picture, True)
    except expat.ExpatError as error:
        raise ValueError(f"a picture is no SVG: {error}") from None
    if not picture.startswith("<svg"):
        raise ValueError("a picture is no SVG")


def _take(element: str, attributes: dict[str, str]) -> None:
    if element not in _ELEMENTS:
        raise ValueError(f"a picture has an element {element[:40]!r}")
    for name, value in attributes.items():
        allowed = _CLASS if name == "class" else _VALUE
        if name not in _ATTRIBUTES or not allowed.fullmatch(value):
            raise ValueError(f"a picture has {name[:40]}={value[:40]!r}")
