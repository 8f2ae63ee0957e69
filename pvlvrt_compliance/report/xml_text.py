"""Text and names as XML files have them."""

import itertools
import re

_NOT_IN_XML = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"  # takes 5 ms to compile


def unique_name(classname: str, name: str, taken: set[tuple[str, str]]) -> str:
    """A name that no other case of the class has: the second of one is ``name (2)``; it is then among the taken."""
    candidates = itertools.chain([name], (f"{name} ({n})" for n in itertools.count(2)))
    free = next(c for c in candidates if (classname, c) not in taken)
    taken.add((classname, free))
    return free


def xml_text(value: str) -> str:
    """A text without what XML cannot hold."""
    return value if value.isascii() and value.isprintable() else re.sub(_NOT_IN_XML, "\ufffd", value)
