"""What a page says of a command's arguments and options, made from the command line's own definitions."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from pvlvrt_compliance.cli.main import app
from validation.places import DOCS

FOLDER = DOCS / "commands"
BEGIN, END = "<!-- options -->\n", "<!-- end of options -->\n"

_PROGRAM = "pvlvrt-check"
_UNGROUPED = "Options"
_OPTION = re.compile(r"--[a-z][a-z-]+")


def commands() -> dict[tuple[str, ...], Any]:
    """Every command that does something, by the words that call it; the main one by none."""
    root: Any = typer.main.get_command(app)
    return {(): root, **dict(_beneath(root, ()))}


def pages() -> dict[tuple[str, ...], Path]:
    """The page of each command."""
    return {words: FOLDER / f"{'-'.join(words) or _PROGRAM}.md" for words in commands()}


def table(command: Any) -> str:
    """Arguments and options of a command, a table a group, as they stand in its help."""
    groups: dict[str, list[Any]] = {}
    for param in command.params:
        if getattr(param, "hidden", False):
            continue
        groups.setdefault(_group(param), []).append(param)
    return "\n".join("\n".join(_lines(name, params)) for name, params in groups.items()) or "It takes none.\n"


def with_table(text: str, command: Any) -> str:
    """The text of a page with its command's table in its place."""
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    return f"{head}{BEGIN}\n{table(command)}\n{END}{tail}"


def stale() -> list[str]:
    """Names of the pages that say something else than the command line."""
    found = {file: command for file, command in zip(pages().values(), commands().values(), strict=True)}
    return [file.name for file, command in found.items() if _text(file) != with_table(_text(file), command)]


def write() -> None:
    """Write the tables into the pages."""
    for words, command in commands().items():
        file = pages()[words]
        file.write_text(with_table(_text(file), command), "utf-8")


def _text(file: Path) -> str:
    return file.read_text("utf-8")


def _beneath(group: Any, words: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    for name, command in group.commands.items():
        called = (*words, name)
        if hasattr(command, "commands"):
            yield from _beneath(command, called)
        else:
            yield called, command


def _group(param: Any) -> str:
    return "Arguments" if param.param_type_name == "argument" else (param.rich_help_panel or _UNGROUPED)


def _lines(name: str, params: list[Any]) -> Iterator[str]:
    yield from (f"| {name} | |", "|---|---|")
    yield from (f"| {_called(param)} | {_words(param.help)}{_default(param)} |" for param in params)
    yield ""


def _called(param: Any) -> str:
    names = [] if param.param_type_name == "argument" else [", ".join(f"`{name}`" for name in param.opts)]
    values = " or ".join(f"`{value}`" for value in (param.metavar or "").split("|") if value)
    return " ".join([*names, values] if values else names)


def _default(param: Any) -> str:
    return f" Default: `{param.default}`." if isinstance(param.default, str) and param.default else ""


def _words(text: str) -> str:
    """A help text within a cell: options in it stay whole, and a bracket that is no markup is one."""
    return _OPTION.sub(r"`\g<0>`", text.replace(r"\[", "[")).replace("|", r"\|")
