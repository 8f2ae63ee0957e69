"""Looks of a page's pictures told once: of what thousands of paths are drawn like, each path has a class alone."""

import re

# What follows the coordinates of a path; one that has a class already is left as it is.
_PATH = re.compile(r'<path d="([^"]*)"((?: [a-z-]+="[^"]*")+)/>')
_ATTRIBUTE = re.compile(r' ([a-z-]+)="([^"]*)"')
_PROPERTIES = {"fill", "fill-opacity", "stroke", "stroke-dasharray", "stroke-opacity", "stroke-width"}
"""Attributes of SVG that CSS has under the same name, with the same values."""


class Looks:
    """The looks that occur on a page, each under a short name."""

    def __init__(self) -> None:
        self._names: dict[str, str] = {}

    def shortened(self, picture: str) -> str:
        """A picture whose paths name their looks; it needs `style` beside it."""
        return _PATH.sub(self._named, picture)

    def style(self) -> str:
        """What the names mean, as CSS."""
        return "".join(f".{name}{{{_declared(look)}}}" for look, name in self._names.items())

    def _named(self, path: re.Match[str]) -> str:
        coordinates, look = path.groups()
        if not {name for name, _ in _ATTRIBUTE.findall(look)} <= _PROPERTIES:
            return path.group()
        name = self._names.setdefault(look, f"k{len(self._names)}")
        return f'<path class="{name}" d="{coordinates}"/>'


def _declared(look: str) -> str:
    return ";".join(f"{name}:{value}" for name, value in _ATTRIBUTE.findall(look))
