"""Which plant signal or command a port means: by its name, unless its unit or its description contradicts that."""

import re
from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from pvlvrt_compliance.controllers.mapping.described import Said, contradiction, said_in, support
from pvlvrt_compliance.controllers.mapping.perhaps_a_switch import may_be_switch
from pvlvrt_compliance.controllers.mapping.port_units import misfit, spelled
from pvlvrt_compliance.controllers.mapping.quantities import (
    PHASES,
    Meaning,
    Other,
    in_phase,
    phase_of,
    quantity_of,
)
from pvlvrt_compliance.controllers.mapping.words import (
    APPARENT,
    EXACT,
    INPUT_NAMES,
    OF_TWO_PHASES,
    OUTPUT_NAMES,
    PAIRS,
    TOLD_NAMES,
    WITH_SIBLINGS,
    WORKING,
    Known,
    Unclear,
)
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS


class Guess(NamedTuple):
    """What a port means."""

    names: tuple[str, ...] = ()  # a signal or command for every element; empty: nothing is known
    note: str = ""  # why nothing is
    unit: str = ""  # that the name ends in
    inverted: bool = False  # whether it says the opposite of the command
    candidates: tuple[str, ...] = ()  # what it could be, where that is not known


class Hints(NamedTuple):
    """What there is to go by besides a port's name."""

    unit: str = ""
    description: str = ""
    beside: Collection[str] = ()  # keys of the names of all ports of its side: see `key_of`


NO_HINTS = Hints()
"""A name alone."""


_TAIL = re.compile(r"_(v|kv|a|ka|w|kw|mw|var|kvar|mvar|va|kva|mva|hz|pu|s|ms|us)$", re.IGNORECASE)
_MEASURED = re.compile(
    r"_?(?i:meas|measured|feedback)$|_(?i:mes|fb|in|act|actual|sens|sensed)$|(?<=[a-z])(?:Fb|In|Mes)$"
)
_MEASURED_FIRST = re.compile(r"^(?:meas|measured)_", re.IGNORECASE)
_PLAIN = re.compile(r"[A-Za-z0-9_.:\[\]() ]+(?:-[A-Za-z0-9_.:\[\]() ]+)*\*?")
_ALL_PHASES = ("l1l2l3", "l123", "abc", "123", "rst", "uvw")
_FAMILIES = (("r", "y", "b"), ("l1", "l2", "l3"), ("r", "s", "t"), ("u", "v", "w"), ("1", "2", "3"))
_PERHAPS = 'a switch, or what is only told? It could be {}; a mapping file says which, "{}" or {{record = "{}"}}'
_MOST_BY_UNIT = 4
_LONGEST = 100
"""Letters of a name that is looked at (chosen): those that makers use have some 20."""


def key_of(name: str) -> str | None:
    """A name without capitals and separators; None of one with other letters or signs, which are never dropped."""
    if len(name) > _LONGEST or not _PLAIN.fullmatch(name):
        return None
    return re.sub(r"[^a-z0-9]", "", name.replace("*", "star").casefold())


def guess_input(name: str, width: int, hints: Hints = NO_HINTS) -> Guess:
    """Signals that an input of this name and so many elements means."""
    exact = EXACT.get(name)
    if name == "VA" and not {"vb", "vc"} <= set(hints.beside):
        exact = APPARENT
    if exact is not None and width == 1:
        return _unclear(exact, hints, said_in(hints.description), "", width)
    return _guess(name, width, hints, INPUT_NAMES, SIGNALS)


def guess_output(name: str, width: int, hints: Hints = NO_HINTS) -> Guess:
    """Commands that an output means."""
    found = _guess(name, width, hints, OUTPUT_NAMES, COMMANDS)
    if not (found.names or found.note or any(_commands(key) for key in hints.beside)):
        found = _guess(name, width, hints, TOLD_NAMES, COMMANDS)
    if found.names or found.note or width != 1 or len(name) > _LONGEST:
        return found
    switch = may_be_switch(name, hints.unit, hints.description, hints.beside)
    return Guess(note=_PERHAPS.format(switch, switch, name), candidates=(switch,)) if switch else found


def _commands(key: str) -> bool:
    """Whether an output of this name commands a phase."""
    found = OUTPUT_NAMES.get(key) if key in OUTPUT_NAMES else next(iter(_of_three(key, OUTPUT_NAMES)), None)
    return isinstance(found, str) and bool(phase_of(found))


def _guess(name: str, width: int, hints: Hints, known: Known, all_names: Sequence[str]) -> Guess:
    if name in all_names and "_" in name:  # spelled as only here, it is meant so, whatever words stand beside it
        hints = hints._replace(description="")
    for text, tail, prefix in _readings(name, outputs=all_names is COMMANDS):
        key = key_of(text)
        found = None if key is None else _lookup(key, width, hints.beside, known)
        if key is None or found is None:
            continue
        said = _in_its_letters(said_in(f"{prefix} {hints.description}"), key, hints.beside)
        if isinstance(found, Unclear):
            return _unclear(found, hints, said, tail, width)
        why = _why_not(found[0], hints, said, tail, wide=width > 1)
        if why:
            return _contradicted(found, why, hints, said, all_names)
        return Guess(found, unit=tail, inverted=all_names is COMMANDS and key in WORKING)
    return _beyond_ascii(name, width, hints, known, all_names)


def _readings(name: str, *, outputs: bool, prefix: str = "") -> Iterator[tuple[str, str, str]]:
    """The name, or what is left of it without a unit, a word like measured or a group; the unit; the group."""
    yield name, "", prefix
    if len(name) > _LONGEST:
        return
    if tail := _TAIL.search(name):
        yield name[: tail.start()], tail[1], prefix
    for pattern in () if outputs else (_MEASURED, _MEASURED_FIRST):
        if found := pattern.search(name):
            yield from _readings(name[: found.start()] + name[found.end() :], outputs=outputs, prefix=prefix)
            return
    group, dot, last = name.rpartition(".")
    if dot and last:
        yield from _readings(last, outputs=outputs, prefix=group.replace(".", " "))


def _lookup(key: str, width: int, beside: Collection[str], known: Known) -> tuple[str, ...] | Unclear | None:
    """What a key means: a name for every element, or what it may mean."""
    if width == len(PHASES) and (three := _of_three(key, known)):
        return three
    if width == len(PHASES) and (unclear := _unclear_three(key, known)):
        return unclear
    if width != 1:
        found = known.get(key)
        return Unclear(found.question, ()) if isinstance(found, Unclear) else None
    if one := _one_of_three(key, beside, known):
        return one
    if key in WITH_SIBLINGS and known is INPUT_NAMES and not {f"{key[:-1]}a", f"{key[:-1]}b"} <= set(beside):
        return WITH_SIBLINGS[key]
    of_pairs = key in PAIRS and known is INPUT_NAMES and set(PAIRS[key]) <= set(beside)
    found = OF_TWO_PHASES if of_pairs else known.get(key)
    return (found,) if isinstance(found, str) else found


def _of_three(key: str, known: Known) -> tuple[str, ...]:
    """Names for the elements of a port for three phases, from that of its phase a."""
    for found in map(known.get, _first_of_three(key)):
        if isinstance(found, str) and phase_of(found) == "a":
            return tuple(in_phase(found, phase) for phase in PHASES)
    return ()


def _unclear_three(key: str, known: Known) -> Unclear | None:
    """What a port for three phases may mean, by its phase a."""
    for found in map(known.get, _first_of_three(key)):
        if isinstance(found, Unclear) and any(isinstance(m, str) and phase_of(m) == "a" for m in found.meanings):
            return found
    return None


def _first_of_three(key: str) -> list[str]:
    return [key.replace(word, "a", 1) for word in _ALL_PHASES if word in key] or [f"{key}a"]


def _one_of_three(key: str, beside: Collection[str], known: Known) -> tuple[str, ...] | None:
    """The phase of a name whose two siblings are there: U1 U2 U3, VR VS VT, Iu Iv Iw, Vabc[1] Vabc[2] Vabc[3]."""
    for family in (*_FAMILIES, ("0", "1", "2")):
        for k, mark in enumerate(family):
            for match in re.finditer(mark, key):
                before, after = key[: match.start()], key[match.end() :]
                around = f"{before}{after}"
                if not before or (family[0] == "0" and "abc" not in around):
                    continue
                if not all(f"{before}{other}{after}" in beside for other in family):
                    continue
                if family[2] == "b" and f"{before}a{after}" in beside:
                    continue
                if mark.isdigit() and "abc" not in around and f"{before}4{after}" in beside:
                    continue
                found = known.get(f"{before.removesuffix('abc')}a{after}")
                if isinstance(found, str) and phase_of(found) == "a":
                    return (in_phase(found, PHASES[k]),)
    return None


def _in_its_letters(said: Said, key: str, beside: Collection[str]) -> Said:
    """What is said of a port, where phase B beside R and Y is the third."""
    places = [(key[: match.start()], key[match.end() :]) for match in re.finditer("b", key)]
    if not any({f"{before}r{after}", f"{before}y{after}"} <= set(beside) for before, after in places):
        return said
    return said._replace(phases=frozenset("c" if phase == "b" else phase for phase in said.phases))


def _why_not(meaning: Meaning, hints: Hints, said: Said, tail: str, *, wide: bool) -> str:
    """What speaks against a meaning; empty where nothing does."""
    if tail and hints.unit and spelled(tail) != spelled(hints.unit):
        return f"its name ends in {tail}, its unit is {hints.unit}"
    if text := misfit(quantity_of(meaning), hints.unit or tail):
        return text
    if spelled(hints.unit or tail) == "duty":  # of a duty that says its unit, the description may speak
        said = said._replace(quantities=said.quantities - {"share"})
    if words := contradiction(meaning, said, wide=wide):
        return f"its {'description' if hints.description else 'group'} speaks of {words}"
    return ""


def _contradicted(names: tuple[str, ...], why: str, hints: Hints, said: Said, all_names: Sequence[str]) -> Guess:
    wide = len(names) > 1
    fitting = [] if wide else [n for n in all_names if n not in names and not _why_not(n, hints, said, "", wide=wide)]
    best = max((support(name, said) for name in fitting), default=0)
    by_description = [name for name in fitting if support(name, said) == best > 1]
    by_unit = fitting if hints.unit and spelled(hints.unit) != "pu" and not by_description else []
    candidates = (*names, *by_description, *(by_unit if len(by_unit) <= _MOST_BY_UNIT else ()))
    note = f"by its name {_or(names)}, but {why}"
    return Guess(note=f"{note}; it could be {_or(candidates)}" if candidates != names else note, candidates=candidates)


def _unclear(found: Unclear, hints: Hints, said: Said, tail: str, width: int) -> Guess:
    """What the unit and the description leave of several meanings."""
    named = _phased([m for m in found.meanings if isinstance(m, str)], width)
    against = {m: _why_not(m, hints, said, tail, wide=width > 1) for m in found.meanings}
    left = [m for m in found.meanings if not against[m]]
    best = max((support(m, said) for m in left), default=0)
    likely = [m for m in left if support(m, said) == best] if best > 1 else left
    if len(likely) == 1 and isinstance(likely[0], str) and len(found.meanings) > 1:
        return Guess(_phased(likely, width), unit=tail)
    candidates = _phased([m for m in left if isinstance(m, str)], width)
    could = ""
    if candidates:
        could = f"it could be {_or((*candidates, *(m.words for m in left if isinstance(m, Other))))}"
    elif named:
        could = f"by its name {_or(named)}, but {against[named[0]]}"
    if could:
        could = f" {could[0].upper()}{could[1:]}" if found.question.endswith("?") else f"; {could}"
    return Guess(note=f"{found.question}{could}", candidates=candidates or named)


def _phased(names: Sequence[Meaning], width: int) -> tuple[str, ...]:
    """Signals or commands by their names, of a port for three phases each of them in all phases."""
    found = [name for name in names if isinstance(name, str)]
    if width == 1:
        return tuple(found)
    return tuple(in_phase(name, phase) for name in found for phase in PHASES if phase_of(name) == "a")


def _beyond_ascii(name: str, width: int, hints: Hints, known: Known, all_names: Sequence[str]) -> Guess:
    """Of a name with letters or signs that are not known: what it would be without them, untied."""
    if key_of(name) is not None:
        return Guess()
    plain = re.sub(r"[^A-Za-z0-9_.:\[\]()]", "", name)
    found = _guess(plain, width, hints, known, all_names) if key_of(plain) else Guess()
    candidates = found.names or found.candidates
    if not candidates:
        return Guess()
    others = "".join(dict.fromkeys(re.sub(r"[A-Za-z0-9_.:\[\]() ]", "", name)))
    return Guess(
        note=f"its name has {others!r}, which may change what it means; without that it would be {_or(candidates)}",
        candidates=candidates,
    )


def _or(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last
