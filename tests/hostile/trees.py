"""Damage of what a file says: its tables, keys, numbers and texts, written again as TOML or JSON."""

import json
from collections.abc import Callable, Iterator
from copy import deepcopy
from datetime import date
from random import Random
from typing import Any

from tests.hostile import values

Path = tuple[Any, ...]


class Raw(str):
    """What is written as it stands."""

    __slots__ = ()


def places(tree: Any, path: Path = ()) -> Iterator[Path]:
    """Every place in a tree but its root."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, inner in items:
        yield (*path, key)
        yield from places(inner, (*path, key))


def damaged(tree: Any, rng: Random, mild: bool = False) -> Any:
    """A copy with one to four things in it that are other than they were; mild ones keep their kind and their sign."""
    made = deepcopy(tree)
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        every = list(places(made))
        if not every:
            break
        *to, last = rng.choice(every)
        holder = made
        for key in to:
            holder = holder[key]
        (_shift if mild else rng.choice((_nudge, _replace, _replace, _move)))(holder, last, rng)
    return made


def _shift(holder: Any, key: Any, rng: Random) -> None:
    """Another number near by, or more of a text that is prose: what may well be right."""
    old = holder[key]
    if isinstance(old, float):
        holder[key] = old * rng.choice((0.5, 0.9, 0.99, 1.01, 1.1))
    elif isinstance(old, str) and " " in old:
        holder[key] = old + rng.choice((" ", "é", " <b>", " & |", " ::x", " ]]>"))


def _nudge(holder: Any, key: Any, rng: Random) -> None:
    old = holder[key]
    if isinstance(old, bool):
        holder[key] = not old
    elif isinstance(old, int | float):
        near = values.nudged(rng, old)
        holder[key] = round(near) if isinstance(old, int) and rng.random() < 0.7 else near
    elif isinstance(old, list) and old:
        rng.shuffle(old)
    elif isinstance(old, str) and not isinstance(old, Raw):
        holder[key] = old + rng.choice(("", "x", " ", "é"))


def _replace(holder: Any, key: Any, rng: Random) -> None:
    """Put something else in a place, of the same kind or of another."""
    old = holder[key]
    others: list[Callable[[], Any]] = [
        lambda: Raw(values.number(rng)),
        lambda: values.text(rng, 20_000),
        lambda: rng.random() < 0.5,
        lambda: [],
        lambda: {},
        lambda: [deepcopy(old)] * rng.choice((1, 2, 50)),
        lambda: {"value": deepcopy(old)},
        lambda: Raw("[" * 500 + "]" * 500),
        lambda: Raw("{a=" * 200 + "1" + "}" * 200),
        lambda: Raw("1979-05-27T07:32:00Z"),
    ]
    if isinstance(old, list) and old:
        others += [lambda: old * (rng.choice((2, 100, 3000)) // len(old) + 1), lambda: old[:-1]] * 2
    if isinstance(old, int | float):
        others += [others[0]] * 8
    if isinstance(old, str):
        others += [others[1]] * 8
    holder[key] = rng.choice(others)()


def _move(holder: Any, key: Any, rng: Random) -> None:
    """Leave a place out, or have it under another name, twice, or as it stands elsewhere."""
    old = holder[key]
    if isinstance(holder, list):
        if rng.random() < 0.5:
            del holder[key]
        else:
            holder.append(deepcopy(old))
        return
    deed = rng.choice(("drop", "rename", "add", "swap"))
    if deed in ("drop", "rename"):
        del holder[key]
    if deed == "rename":
        holder[rng.choice((key[:-1], key.upper(), f"{key}x", f"{key} ", values.text(rng, 2000)))] = old
    elif deed == "add":
        holder[rng.choice(("unknown", "", "a.b", "tests", values.text(rng, 2000)))] = deepcopy(old)
    elif deed == "swap":
        other = rng.choice(list(holder))
        holder[key], holder[other] = holder[other], holder[key]


def to_json(tree: Any) -> str:
    """As JSON, with what is raw as it stands."""
    if isinstance(tree, Raw):
        return str(tree)
    if isinstance(tree, dict):
        return "{" + ",".join(f"{json.dumps(str(key))}:{to_json(value)}" for key, value in tree.items()) + "}"
    if isinstance(tree, list):
        return "[" + ",".join(map(to_json, tree)) + "]"
    return json.dumps(tree, default=str)


def to_toml(tree: dict[str, Any]) -> str:
    """As TOML: a table under its heading, what lies deeper in one line."""
    return "\n".join(_tables(tree, ()))


def _tables(table: dict[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    later = []
    for key, value in table.items():
        if isinstance(value, dict) and len(path) < 2:
            later.append(("[{}]", key, value))
        elif isinstance(value, list) and value and all(isinstance(each, dict) for each in value) and not path:
            later += [("[[{}]]", key, each) for each in value]
        else:
            yield f"{_key(key)} = {_inline(value)}"
    for heading, key, value in later:
        yield "\n" + heading.format(".".join(map(_key, (*path, key))))
        yield from _tables(value, (*path, key))


def _key(key: str) -> str:
    return key if key.replace("_", "").replace("-", "").isalnum() and key.isascii() else _text(key)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _inline(value: Any) -> str:
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_inline(inner)}" for key, inner in value.items()) + " }"
    return value.isoformat() if isinstance(value, date) else repr(value)
