"""Damage of a file as such: its bytes, its lines, its encoding, and what it is at all."""

import re
from random import Random
from typing import NamedTuple

from tests.hostile import values

BYTES, FOLDER, FIFO, LINK = "bytes", "folder", "fifo", "link"

_NUMBER = re.compile(r"(?<![\w.\"-])-?\d+(\.\d+)?(e-?\d+)?(?![\w.\"-])")
_TEXT = re.compile(r'"[^"\n]*"')
_KEY = re.compile(r"^[\w.\[\]]+", re.MULTILINE)


class File(NamedTuple):
    """What lies in a folder under some name."""

    content: bytes = b""
    kind: str = BYTES
    target: str = ""  # of a link


def of_text(text: str) -> File:
    """An ordinary file."""
    return File(text.encode("utf-8", "surrogatepass"))


def another_kind(rng: Random) -> File:
    """Something that is no ordinary file."""
    if (kind := rng.choice((FOLDER, FIFO, LINK, LINK))) != LINK:
        return File(kind=kind)
    there = (
        "/dev/zero",
        "/dev/null",
        "/dev/full",
        "/dev/random",
        "absent",
        ".",
        "itself",
        "/proc/self/environ",
        "/etc",
    )
    return File(kind=LINK, target=rng.choice(there))


def damaged_text(text: str, rng: Random) -> str:
    """A text of which some lines, numbers, texts or keys are others."""
    for _ in range(rng.choice((1, 1, 2, 5))):
        text = rng.choice((_line, _token, _token, _token))(text, rng)
    return text


def _line(text: str, rng: Random) -> str:
    """Leave a line out, have it twice, elsewhere, or with something more in it."""
    lines = text.splitlines(keepends=True)
    if not lines:
        return text
    at = rng.randrange(len(lines))
    deed = rng.choice(("drop", "double", "move", "more"))
    line = lines[at] if deed == "double" else lines.pop(at)
    if deed == "double":
        lines.insert(at, line)
    elif deed == "move":
        lines.insert(rng.randrange(len(lines) + 1), line)
    elif deed == "more":
        place = rng.randrange(len(line))
        lines.insert(at, line[:place] + values.text(rng, 20_000) + line[place:])
    return "".join(lines)


def _token(text: str, rng: Random) -> str:
    """Another number in place of a number, another text in place of a text, another key in place of a key."""
    pattern = rng.choice((_NUMBER, _NUMBER, _TEXT, _KEY))
    found = list(pattern.finditer(text))
    if not found:
        return text
    begin, end = (chosen := rng.choice(found)).span()
    old = chosen.group()
    if pattern is _NUMBER:
        new = values.number(rng) if rng.random() < 0.5 else repr(values.nudged(rng, float(old)))
    elif pattern is _TEXT:
        new = f'"{values.text(rng, 20_000)}"' if rng.random() < 0.7 else values.number(rng)
    else:
        new = rng.choice((old[:-1], f"{old}x", old.upper(), f'"{values.text(rng, 500)}"', rng.choice(found).group()))
    return text[:begin] + new + text[end:]


def damaged_bytes(content: bytes, rng: Random) -> bytes:
    """Bytes of which some are flipped, missing, doubled or in another encoding."""
    return rng.choice(_DEEDS)(content, rng)


def _flip(content: bytes, rng: Random) -> bytes:
    made = bytearray(content)
    for _ in range(rng.choice((1, 3, 30)) if made else 0):
        made[rng.randrange(len(made))] ^= 1 << rng.randrange(8)
    return bytes(made)


def _cut(content: bytes, rng: Random) -> bytes:
    return content[: rng.randrange(len(content) + 1)]


def _insert(content: bytes, rng: Random) -> bytes:
    at = rng.randrange(len(content) + 1)
    return content[:at] + rng.randbytes(rng.choice((1, 10, 1000))) + content[at:]


def _encode(content: bytes, rng: Random) -> bytes:
    text = content.decode("utf-8", "replace")
    return text.encode(rng.choice(("utf-16", "utf-32", "latin-1", "cp1252", "utf-8-sig", "utf-7")), "replace")


def _lines(content: bytes, rng: Random) -> bytes:
    return content.replace(b"\n", rng.choice((b"\r\n", b"\r", b"\n\n", b"\x00\n", b"\x85")))


def _whole(content: bytes, rng: Random) -> bytes:
    return rng.choice(
        (b"", content + content, rng.randbytes(3000), b"\x00" * 5000, content + b"#" * 2_000_000, b"\xef\xbb\xbf")
    )


_DEEDS = (_flip, _flip, _cut, _insert, _encode, _lines, _whole)


def damaged_file(text: str, rng: Random) -> File:
    """A file of a text, damaged in one of these ways."""
    at = rng.random()
    if at < 0.04:
        return another_kind(rng)
    if at < 0.25:
        return File(damaged_bytes(text.encode("utf-8"), rng))
    return of_text(damaged_text(text, rng))
