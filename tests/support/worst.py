"""The worst text that somebody may send, and what may be left of it where somebody reads it.

What `seen` goes by is Unicode's own categories, not the list of the package.
"""

import csv
import io
import json
import re
import unicodedata
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lxml.etree
import lxml.html
import pypdf
from markdown_it import MarkdownIt

MARK = "Ωäё测试"
"""Letters that are kept wherever the text is shown: without them a test has looked at nothing."""

_COMMANDS = "\n::error::x\r\n  ::set-output name=a::b\n##[error]y\n##vso[task.complete]z\n##teamcity[x]\n"
_MARKUP = (
    "[bold]b[/bold][link=https://evil.example]l[/link] :smile: <script>alert(1)</script><img src=x onerror=alert(1)>"
    " ]]>&amp;&#x1b; | cell | [x](https://evil.example) ![y](https://evil.example/i.png) `c` {{ 1 }} @team \n# h\n"
)
_SIGNS = "\x07\x08\x1b]0;t\x07\x1b[31m\x1b[2J\x7f\x80\x85\x9b31m\ufffe\uffff"
_DIRECTIONS = "\u202a\u202e\u2066\u2069\u200b\u200d\u200f\u2028\u2029\u00ad\u2060\ufeff\U000e0041\U0001fffe\u3164"

IN_XML = f"{MARK}{_COMMANDS}{_MARKUP}{_DIRECTIONS}{MARK}".replace("\ufffe", "").replace("\U0001fffe", "")
"""What a file of XML can hold of it."""

IN_TOML = f"{MARK}{_MARKUP}{_COMMANDS}{_DIRECTIONS}{MARK}".replace("\r", "")
"""What a file that people write can hold: those have no control characters."""

IN_C = f"{MARK}{_SIGNS}{_COMMANDS}{_MARKUP}{_DIRECTIONS}{MARK}"
"""What a text of C can hold; what is an argument or a name of a file, too."""

WORST = f"{IN_C}\x00\udcff\ud800{'x' * 30_000}"
"""All of it, and far too long."""

NAME = f"{MARK}\x1b[2J\x07\x9b\u202e\u200b\n::error::x\r##[e]##vso[a][bold]<b>|`*"
"""What a name of a file can hold, its slashes left out; short enough for one."""

LONGEST = 10_000
"""Characters that nothing shown of one text has."""

_VISIBLE_FORMATS = "؀؁؂؃؄؅۝܏࣢𑂽𑃍"
_INVISIBLE_LETTERS = "\u034f\u115f\u1160\u17b4\u17b5\u3164\uffa0"
_OF_A_CI = re.compile(r"^[^\S\n]*::|##\w*\[", re.MULTILINE)
_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_PARSER = MarkdownIt("commonmark").enable(["table", "strikethrough"])
_OUR_MARKUP = {"<details>", "</details>", "<summary>", "</summary>", "<code>", "</code>", "<sub>", "</sub>"}
IN_SHEETS = "Ωäё[U+6D4B][U+8BD5]"
"""What is left of the mark in a PDF, whose fonts have not all letters."""

_BREAK = "\u200b"  # our own, between characters that a service would make something of


def seen(text: str, where: object = "") -> None:
    """Check that a text holds what can be seen, and lines, and nothing else; that no line commands a CI service."""
    all_seen(text, where)
    assert not (found := _OF_A_CI.search(text)), (where, found)


def all_seen(text: str, where: object) -> None:
    """The same of a part of a line."""
    hidden = {f"{ord(c):04x}" for c in text if c != "\n" and _is_hidden(c)}
    assert not hidden, (where, hidden)


def _is_hidden(character: str) -> bool:
    code = ord(character)
    if code & 0xFFFE == 0xFFFE or 0xFDD0 <= code <= 0xFDEF or character in _INVISIBLE_LETTERS:
        return True
    is_format = unicodedata.category(character) == "Cf" and character not in _VISIBLE_FORMATS
    return is_format or unicodedata.category(character) in ("Cc", "Cs", "Zl", "Zp")


def of_a_terminal(text: str) -> str:
    """The same of what a terminal gets, without the sequences that rich writes: colour, and a bar while it lasts.

    Whoever sends `WORST` has sent such sequences, too; his are gone with the characters that they begin with.
    """
    assert "\x1b[31m\x1b[2J" not in text
    assert "\x1b]" not in text
    bare = _ESCAPES.sub("", text).replace("\r", "")
    seen(bare, "terminal")
    return bare


def data(found: Any, where: object = "") -> None:
    """Check every text of plain data."""
    if isinstance(found, str):
        seen(found, where)
        assert len(found) <= LONGEST or found.startswith("data:image/"), (where, len(found))
    elif isinstance(found, dict):
        for key, value in found.items():
            data(key, where)
            data(value, f"{where}.{key[:60]}")
    elif isinstance(found, list):
        for value in found:
            data(value, where)


def output_folder(folder: Path) -> str:
    """Check every file of a run or a comparison; all that can be read in them."""
    return "\n".join(text_of(file) for file in sorted(folder.rglob("*")) if file.is_file())


def text_of(file: Path) -> str:
    """Check one file; all that can be read in it."""
    seen(file.name, file)
    if file.suffix in _LOOKED_AT:
        return _LOOKED_AT[file.suffix](file.read_bytes(), file.name)
    assert file.suffix in _NOT_TEXT, f"nobody looks at texts in {file.name}"
    return ""


def _page(content: bytes, where: str) -> str:
    assert not (found := _OF_A_CI.search(content.decode("utf-8"))), (where, found)
    root = lxml.html.document_fromstring(content)
    for element in root.iter():
        if not isinstance(element.tag, str):
            continue
        _attributes(element, where)
        if element.tag == "script":
            assert "alert(1)" not in (element.text or "").replace("<", "").split("application/json")[0] or element.get(
                "type"
            ), where
        elif element.tag != "style":
            _nodes(element, where)
    return root.text_content()


def _attributes(element: Any, where: str) -> None:
    assert element.tag != "img" or element.get("src", "").startswith("data:image/"), where
    for name, value in element.attrib.items():
        assert not (name.startswith("on") and "alert" in value), where
        assert "evil.example" not in value or name not in ("href", "src"), where
        all_seen(value.replace("\t", " "), f"{where} {element.tag} {name}")


def _nodes(element: Any, where: str) -> None:
    for text in (element.text, element.tail):
        if text == _BREAK and element.tag.endswith("tspan"):
            continue  # our own: it takes a name of a figure back to its line
        all_seen((text or "").replace("\t", " "), f"{where} {element.tag}")


def _xml(content: bytes, where: str) -> str:
    assert not (found := _OF_A_CI.search(content.decode("utf-8"))), (where, found)
    root = lxml.etree.fromstring(content)
    for element in root.iter():
        if isinstance(element.tag, str):
            _attributes(element, where)
            _nodes(element, where)
    return "\n".join([*root.itertext(), *(value for each in root.iter() for value in each.attrib.values())])


def _json(content: bytes, where: str) -> str:
    found = json.loads(content.decode("utf-8"))
    data(found, where)
    return "\n".join(_texts_in(found))


def _texts_in(found: Any) -> Iterator[str]:
    if isinstance(found, str):
        yield found
    for value in found.values() if isinstance(found, dict) else found if isinstance(found, list) else ():
        yield from _texts_in(value)


def _markdown(content: bytes, where: str) -> str:
    text = content.decode("utf-8")
    seen(text.replace(_BREAK, ""), where)
    tokens = _PARSER.parse(text)
    each = [*tokens, *(child for token in tokens for child in token.children or ())]
    assert {token.content.strip() for token in each if token.type in ("html_inline",)} <= _OUR_MARKUP, where
    assert "evil.example" not in str([token.attrs for token in each]), where
    assert "image" not in {token.type for token in each}, where
    return text.replace(_BREAK, "")


def _table(content: bytes, where: str) -> str:
    text = content.decode("utf-8")
    for row in csv.reader(io.StringIO(text, newline="")):
        data(row, where)
    return text


def _lines(content: bytes, where: str) -> str:
    text = content.decode("utf-8").replace("\r\n", "\n")
    seen(text, where)
    return text


def _sheets(content: bytes, where: str) -> str:
    """A PDF: what can be read on its sheets and is told about it; nothing in it leads out of it or is run."""
    reader = pypdf.PdfReader(io.BytesIO(content))
    assert not {"/OpenAction", "/AA"} & reader.root_object.keys(), where
    told = [str(value) for value in (reader.metadata or {}).values()]
    for page in reader.pages:
        links = [link.get_object() for link in page.get("/Annots") or ()]
        assert {str(link.get("/A", {}).get("/S", "/GoTo")) for link in links} <= {"/GoTo", "/URI"}, where
        assert "evil.example" not in str([link.get("/A", {}).get("/URI") for link in links]), where
        told.append(page.extract_text().replace(_BREAK, ""))
    for text in told:
        all_seen(text, where)
    return "".join("\n".join(told).split())


_LOOKED_AT = {
    ".html": _page,
    ".xml": _xml,
    ".svg": _xml,
    ".json": _json,
    ".md": _markdown,
    ".pdf": _sheets,
    ".csv": _table,
    ".cfg": _lines,
    ".txt": _lines,
    ".toml": _lines,
}
_NOT_TEXT = {".dat", ".zip", ".png"}  # numbers; what is packed
