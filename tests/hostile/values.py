"""Values that nobody means well with, and some that are merely unusual."""

from random import Random
from unicodedata import category

DIGITS = "9" * 5000

NUMBERS = (
    "0", "-0", "0.0", "-1", "1", "2", "1e308", "-1e308", "1e-308", "5e-324", "1e309", "nan", "-nan", "inf", "-inf",
    "+inf", "1e5000", "-1e-5000", "9223372036854775807", "9223372036854775808", "-9223372036854775809", "4294967296",
    DIGITS, f"-{DIGITS}", f"0.{DIGITS}", f"{DIGITS}.5", "0x10", "0o17", "0b1", "1_000", "1__0", "01", "1e", ".5", "5.",
    "1,5", "--5", "+-5", "1e3.5", "NaN", "Infinity", "true", "null", "½", "٣", "１２", "1 000",
)  # fmt: skip
"""As they are written in a file or on a command line; of some it is the spelling that is wrong."""

CONTROL = ("\x1b[31mred\x1b[0m", "a\x07\x08b", "\x1b]0;title\x07", "\x9b31m", "\x7f", "a\x0bb\x0cc", "\x85next", "\r")
RUNNER = ("::error::forged", "\n::set-output name=x::y", "##[error]forged", "  ::stop-commands::x", "a\r::debug::x")
MARKUP = (
    "<script>alert(1)</script>", "]]>", "<!-- a", "&amp;&#0;&lt", "'\"><img src=x onerror=alert(1)>", "{{ 7*7 }}",
    "{% raw %}", "[bold red]x[/]", "[/]", "|a|b|", "![x](javascript:alert(1))", "`a` **b** _c_ #d", "#let x = 1", "$x$",
    "\\u0000", "%s%n%x", "${HOME}", "$(id)", "`id`", ";id", "=cmd|' /C calc'!A0",
)  # fmt: skip
UNICODE = (
    "\u202egnp.exe", "\ufeffa", "a\u2028b", "a\u2029b", "\u200b", "e\u0301", "Z" + "\u0336" * 300, "👩‍👩‍👧‍👦", "ﷺ" * 20,
    "\ufffe", "\U0010ffff", "ß" * 50, "İ", "\u0000", "ﬁ", "А", "\ue000",
)  # fmt: skip
PATHS = (
    "/dev/zero", "/dev/null", "/dev/full", "/dev/random", "/proc/self/mem", "/proc/self/environ", "/etc/passwd", ".",
    "..", "/", "~", "~nobody/x", "../" * 40 + "etc/passwd", "a/" * 300, "x" * 300, "x" * 5000, "con", "a\\b", "a:b",
    "-", "--", "-x", "file://x", "absent/file.toml", "*", "?", "[", "a b",
)  # fmt: skip
WORDS = (
    "",
    " ",
    "\t",
    "a",
    "all",
    "none",
    "auto",
    "bundled",
    "null",
    "x" * 100_000,
    "a=b",
    "a=b=c",
    "=",
    ",",
    "a,b",
    "%",
)

TEXTS = (*CONTROL, *RUNNER, *MARKUP, *UNICODE, *PATHS, *WORDS)
"""Texts for the worst of places."""

NO_TEXT = ("\udcff", "a\udc80\udcfeb")
"""What bytes of an argument become that are no text; no file holds them."""


def number(rng: Random) -> str:
    """A number, or something written like one."""
    return rng.choice(NUMBERS)


def text(rng: Random, longest: int = 200_000) -> str:
    """A text; now and then of two parts."""
    made = rng.choice(TEXTS)
    if rng.random() < 0.2:
        made += rng.choice(TEXTS)
    return made[:longest]


def argument(rng: Random) -> str:
    """What can stand on a command line, which ends at a zero byte."""
    made = rng.choice((text, number))(rng)
    if rng.random() < 0.05:
        made += rng.choice(NO_TEXT)
    return made.replace("\x00", "")[:100_000]


def nudged(rng: Random, value: float) -> float:
    """A number near another one, or of the other sign, or none: such pass what reads them, and come far."""
    factor = rng.choice((0.5, 0.9, 0.99, 1.01, 1.1, 2.0, 10.0, 0.1, -1.0, 0.0))
    return value * factor if value else factor


def seen(rng: Random, longest: int) -> str:
    """A text in which nothing is a control character."""
    made = text(rng, longest)
    return "".join(x for x in made if category(x) not in ("Cc", "Cs")) or "x"
