"""How GitHub's runner reads the output of a step, written from its rules and sharing nothing with the package."""

import re
from typing import NamedTuple

_LINE = re.compile(r"\r\n|\r|\n")


class Command(NamedTuple):
    """A line that the runner takes as a command."""

    name: str
    properties: dict[str, str]
    message: str


def commands(output: str) -> list[Command]:
    """Commands in what a step has printed, in order, whatever their names."""
    found = (_command(line) for line in _LINE.split(output))
    return [each for each in found if each is not None]


def _command(line: str) -> Command | None:
    line = line.lstrip()
    if line.startswith("::") and (end := line.find("::", 2)) >= 0:
        name, _, given = line[2:end].partition(" ")
        pairs = (pair.partition("=") for pair in given.split(",") if pair)
        return Command(name, {key.strip(): _plain(value, "3A2C") for key, _, value in pairs}, _plain(line[end + 2 :]))
    begin = line.find("##[")
    end = line.find("]", begin)
    return None if begin < 0 or end < 0 else Command(line[begin + 3 : end].partition(" ")[0], {}, line[end + 1 :])


def _plain(text: str, more: str = "") -> str:
    for code in ("0D", "0A", *re.findall("..", more), "25"):  # the percent sign last: "%250A" is no end of a line
        text = text.replace(f"%{code}", chr(int(code, 16)))
    return text
