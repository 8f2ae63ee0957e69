"""Text that every sheet can show: characters that the fonts have, and words that find an end within a column.

PDF/A wants a glyph for each character, and only the fonts that come with typst are used, so that a report is the same
on every machine. What they lack is spelled out, ``[U+1F600]``.
"""

import re
import unicodedata
from collections.abc import Iterable, Iterator

BREAK = "\u200b"
"""On both sides of what stays on one line: a piece of a long word, a word of code. Not itself written into the PDF."""

SHOWN = (
    (0x20, 0x7E), (0xA0, 0xAC), (0xAE, 0x1C3), (0x1CD, 0x1E3), (0x1E6, 0x1F0), (0x1F8, 0x221), (0x224, 0x241),  # Latin
    (0x250, 0x2B9), (0x1E00, 0x1E99), (0x1EA0, 0x1EF9),
    (0x384, 0x38A), (0x38C, 0x38C), (0x38E, 0x3A1), (0x3A3, 0x3CE), (0x3D0, 0x3E1),  # Greek
    (0x3F0, 0x45F), (0x490, 0x49B), (0x531, 0x556), (0x10D0, 0x10FA),  # Cyrillic, Armenian, Georgian
    (0x621, 0x63A), (0x641, 0x64A), (0x660, 0x669),  # Arabic
    (0x2010, 0x2023), (0x2026, 0x2026), (0x2030, 0x2037), (0x2039, 0x203A), (0x203C, 0x203F),  # punctuation
    (0x2070, 0x2071), (0x2074, 0x208E), (0x2090, 0x209C), (0x20A0, 0x20B5), (0x20BD, 0x20BD),  # raised, lowered, money
    (0x2115, 0x2117), (0x2122, 0x2122), (0x2126, 0x2126), (0x212A, 0x212B), (0x2153, 0x215F),  # letters as symbols
    (0x2190, 0x2213), (0x2215, 0x2215), (0x2217, 0x2220), (0x2223, 0x2224), (0x2227, 0x222D),  # arrows, mathematics
    (0x2234, 0x223D), (0x2241, 0x2269), (0x226D, 0x228B), (0x2308, 0x2315), (0x239B, 0x23AE),
    (0x2500, 0x262F), (0x2638, 0x268B), (0x2701, 0x2704), (0x270C, 0x2727), (0x2729, 0x274B),  # boxes, signs
    (0x2761, 0x2775), (0x2798, 0x27AF), (0xFFFD, 0xFFFD),
)  # fmt: skip
"""First and last code points of what both fonts of the templates together have; a test holds it against them."""

_LONGEST_WORD, _LONGEST_ARGUMENT = 16, 64  # the longest argument is as long as a digest
_LONGEST_PART, _PIECE = 14, 6
_WORD = re.compile(rf"[^\s{BREAK}]+")
_PARTS = re.compile(r"[^\W_]+[\W_]{0,2}|[\W_]{1,2}")
_PIECES = re.compile(rf"[^\W_]{{1,{_PIECE}}}[\W_]{{0,2}}|[\W_]{{1,2}}")
_UNUSUAL = re.compile(r"[^\n\x20-\x7e]")
_ENDS = re.compile(r"\r\n?|[\v\f\x85\u2028\u2029]")


def shown(text: str) -> str:
    """Text in which every character has a glyph and long words can be broken; line ends stay."""
    return _WORD.sub(lambda found: _word(found.group()), told(text))


def code(text: str) -> str:
    """The same of code, as it is copied: no argument that a line has room for is broken."""
    return _WORD.sub(lambda found: _argument(found.group()), told(text))


def told(text: str) -> str:
    """The same with its words whole, for what is told about the document and not laid out."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(map(_spelled, _ENDS.sub("\n", unicodedata.normalize("NFC", text))))


def drawn(picture: str) -> str:
    """A picture as text, SVG, with every character in it that no font has spelled out."""
    return _UNUSUAL.sub(lambda found: _spelled(found.group()), picture)


def _word(word: str) -> str:
    return word if len(word) <= _LONGEST_WORD else _kept(_in_pieces(word))


def _argument(word: str) -> str:
    return _kept([word] if len(word) <= _LONGEST_ARGUMENT else _in_pieces(word))


def _in_pieces(word: str) -> Iterator[str]:
    """Pieces of a long word that end where a part of it does, `docs/`; within a part only where that is long itself."""
    for part in _PARTS.findall(word):
        yield from [part] if len(part) <= _LONGEST_PART else _PIECES.findall(part)


def _kept(pieces: Iterable[str]) -> str:
    return f"{BREAK}{BREAK.join(pieces)}{BREAK}"


def _spelled(character: str) -> str:
    code = ord(character)
    if character == "\n" or any(first <= code <= last for first, last in SHOWN):
        return character
    return " " if character.isspace() else f"[U+{code:04X}]"
