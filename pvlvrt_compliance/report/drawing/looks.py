"""Looks of a page's pictures told once: of what thousands of paths are drawn like, each path has a class alone."""

import re
from base64 import b32encode
from collections.abc import Iterable
from hashlib import blake2b

# What follows the coordinates of a path; one that has a class already is left as it is.
_PATH = re.compile(r'<path d="([^"]*)"((?: [a-z-]+="[^"]*")+)/>')
_ATTRIBUTE = re.compile(r' ([a-z-]+)="([^"]*)"')
_PROPERTIES = {"fill", "fill-opacity", "stroke", "stroke-dasharray", "stroke-opacity", "stroke-width"}
"""Attributes of SVG that CSS has under the same name, with the same values."""

_LOOK = re.compile(f'(?: (?:{"|".join(sorted(_PROPERTIES))})="[A-Za-z0-9 .,()#-]*")+')


NAME = "k[a-z2-7]{8}"
"""What a name of a look is like, as a regular expression."""

_NAME_BYTES = 5  # of 200 looks two have the same name once in fifty million pages


class Looks:
    """The looks that occur on a page, each under a short name, which it has on every page.

    Parameters
    ----------
    told : iterable of str
        Looks of pictures that have been shortened elsewhere.
    """

    def __init__(self, told: Iterable[str] = ()) -> None:
        self._names = {look: _name(look) for look in dict.fromkeys(told)}

    @property
    def told(self) -> tuple[str, ...]:
        """The looks, as they stand in a path that is not shortened."""
        return tuple(self._names)

    def shortened(self, picture: str) -> str:
        """A picture whose paths name their looks; it needs `style` beside it."""
        return _PATH.sub(self._named, picture)

    def style(self) -> str:
        """What the names mean, as CSS."""
        return "".join(f".{name}{{{_declared(look)}}}" for look, name in self._names.items())

    def _named(self, path: re.Match[str]) -> str:
        coordinates, look = path.groups()
        if look not in self._names:
            if not {name for name, _ in _ATTRIBUTE.findall(look)} <= _PROPERTIES:
                return path.group()
            self._names[look] = _name(look)
        return f'<path class="{self._names[look]}" d="{coordinates}"/>'


def is_look(text: str) -> bool:
    """Whether a text is what pictures of ours have as a look, and nothing else in CSS."""
    return bool(_LOOK.fullmatch(text))


def _name(look: str) -> str:
    return "k" + b32encode(blake2b(look.encode(), digest_size=_NAME_BYTES).digest()).decode("ascii").lower()


def _declared(look: str) -> str:
    return ";".join(f"{name}:{value}" for name, value in _ATTRIBUTE.findall(look))
