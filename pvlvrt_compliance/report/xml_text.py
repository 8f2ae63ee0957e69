"""Text and names as XML files have them."""

import itertools

from pvlvrt_compliance.texts import printable


def unique_name(classname: str, name: str, taken: set[tuple[str, str]]) -> str:
    """A name that no other case of the class has: the second of one is ``name (2)``; it is then among the taken."""
    candidates = itertools.chain([name], (f"{name} ({n})" for n in itertools.count(2)))
    free = next(c for c in candidates if (classname, c) not in taken)
    taken.add((classname, free))
    return free


def xml_text(value: str) -> str:
    """A text that XML can hold, even of results that no model has seen."""
    return printable(value, longest=None)
