"""The words of a command line before typer reads them: what is nearly right is refused with what was meant."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Any, NamedTuple

from pvlvrt_compliance.cli.at_once import HELP, VERSION
from pvlvrt_compliance.controllers.spelling import MODULE_AND_CLASS
from pvlvrt_compliance.errors import UsageError, did_you_mean, near_misses
from pvlvrt_compliance.texts import shell_word

_A_CONTROLLER = re.compile(rf"{MODULE_AND_CLASS.pattern}|.+\.py:\w+|.+\.(so|dll|dylib|fmu)|stdio:.+|tcp://.+")
_A_DEPTH = re.compile(r"\d+([.,]\d+)?\s*%")
_A_NUMBER = re.compile(r"[+-]?\d+([.,]\d+)?")
_A_UNIT = re.compile(r"[^\W\d]+(/.*)?|%|°C?")
_PAIR = "--two-phase"
_PROFILE = "--profile"

_LOOKS_AT = {("profiles", _PROFILE): "show", ("controllers", "--controller"): "inspect"}
"""Which command of a group looks at what an option of the main one names."""


def understood(command: Any, arguments: Sequence[str]) -> list[str]:
    """The words as typer takes them.

    Parameters
    ----------
    command : click command or group
        What they are for.
    arguments : sequence of str
        As they were typed, without the program's name.

    Raises
    ------
    UsageError
        When an option is unknown or has no value, stands before a command, which would not see it, or a word is neither
        a command nor the value of an option.
    """
    words = _with_explicit_pair(arguments)
    _check(command, words, ())
    return words


def read_what_is_given(command: Any, words: Sequence[str]) -> None:
    """Have typer read those parameters of a command only that are given in words, unless help is asked for.

    For each that it reads, given or not, and ``--help`` is one, it makes a validator of pydantic's. What is left out
    has the default of its function.
    """
    given = {word.partition("=")[0] for word in words}
    short = any(word[:1] == "-" and word[1:2] not in ("", "-") for word in words)  # several of them may be one word
    if not short and not given & {*HELP}:
        command.add_help_option = False
        command.params = [x for x in command.params if x.required or not _names(x) or given & {*_names(x)}]


def last_of_each_flag(command: Any, words: Sequence[str]) -> list[str]:
    """The words of a command without a flag that is taken back later (``--no-...``), and without what took back one."""
    options = {name: param for param in command.params for name in _names(param)}
    last: dict[str, int] = {}
    flags: list[int] = []
    place = 0
    while place < len(words) and words[place] != "--":
        option = options.get(words[place])
        if option is not None and option.is_flag:
            flags.append(place)
            last[words[place]] = place
        place += 1 + _takes_a_value(option)
    over = {at for at in flags if last.get(_opposite(words[at]), -1) > at}
    return [word for at, word in enumerate(words) if at not in over]


def _opposite(flag: str) -> str:
    return f"--{flag[5:]}" if flag.startswith("--no-") else f"--no-{flag[2:]}"


def _with_explicit_pair(arguments: Sequence[str]) -> list[str]:
    """Read ``--two-phase ab`` and ``--two-phase=ab`` as ``--two-phase --phases ab``: typer has no optional values."""
    given: list[str] = []
    for argument in arguments:
        flag, equals, pair = argument.partition("=")
        if given and given[-1] == _PAIR and not argument.startswith("-"):
            given += ["--phases", argument]
        elif flag == _PAIR and equals:
            given += [_PAIR, "--phases", pair]
        else:
            given.append(argument)
    if sum(argument.partition("=")[0] == "--phases" for argument in given) > 1:
        raise UsageError(f"--phases: given twice ({_PAIR} PAIR names the phases, too)")
    return given


def _check(command: Any, words: Sequence[str], path: tuple[str, ...]) -> None:
    """Go along the words as typer will: options with their values, then the command that they are for."""
    options = {name: param for param in command.params for name in _names(param)}
    is_group = hasattr(command, "commands")
    place = 0
    before: list[str] = []
    while place < len(words) and words[place] != "--":
        word = words[place]
        place += 1
        name, equals, _ = word.partition("=")
        if word in HELP:
            return
        if is_group and _is_no_option(word):
            if word not in command.commands:
                raise UsageError(_no_command(_Place(words, place - 1, path), command.commands, options))
            _check(command.commands[word], words[place:], (*path, word))
            if stray := [option for option in before if option != VERSION]:
                raise UsageError(_before_a_command(stray, command, words[place - 1 :]))
            return
        before.append(name)
        if name.startswith("--") and name not in options:
            raise UsageError(f"no such option: {name}{did_you_mean(name, _shown(command))}")
        if _takes_a_value(options.get(name)) and not equals:
            _refuse_without_value(name, options, words[place : place + 1])
            place += 1
    if is_group and path:
        raise UsageError(f"{' '.join(path)}: a command is missing; there are: {', '.join(command.commands)}")


def _before_a_command(stray: Sequence[str], command: Any, words: Sequence[str]) -> str:
    """What there is to say of options that stand before a command, which is the first of these words."""
    path: list[str] = []
    for word in words:
        if word not in getattr(command, "commands", {}):
            break
        command = command.commands[word]
        path.append(word)
    taken = {name for param in command.params for name in _names(param)}
    given = list(dict.fromkeys(stray))
    stands, them = ("stands", "it") if len(given) == 1 else ("stand", "them")
    said = f'{", ".join(given)} {stands} before "{path[0]}"'
    if others := [name for name in given if name not in taken]:
        return f"{said}; {' '.join(path)} does not take {', '.join(others)}"
    return f"{said}; put {them} behind: pvlvrt-check {' '.join(path)} ... {' '.join(given)}"


def _is_no_option(word: str) -> bool:
    return not word.startswith("-") or word == "-"


def _names(param: Any) -> tuple[str, ...]:
    return (*param.opts, *param.secondary_opts) if param.param_type_name == "option" else ()


def _takes_a_value(option: Any) -> bool:
    return option is not None and not (option.is_flag or option.count)


def _shown(command: Any) -> Iterator[str]:
    return (name for param in command.params if not getattr(param, "hidden", False) for name in _names(param))


def _refuse_without_value(name: str, options: Mapping[str, Any], following: Sequence[str]) -> None:
    """An option at the end has no value, nor one before the name of another: nobody calls a file or a test so."""
    if following and following[0].partition("=")[0] not in {*options, *HELP}:
        return
    before = f" before {following[0]}" if following else ""
    option = options[name]
    raise UsageError(f"{name}: the value is missing{before}; {name} {option.metavar}: {option.help}")


class _Place(NamedTuple):
    """A word among those of a line that is for a group of commands."""

    words: Sequence[str]
    place: int
    path: tuple[str, ...]

    @property
    def word(self) -> str:
        return self.words[self.place]

    @property
    def rest(self) -> str:
        """It and what follows, as a shell reads it back."""
        return " ".join(map(shell_word, self.words[self.place :]))

    def before(self, count: int) -> str:
        """The word that stands so many before it."""
        return self.words[self.place - count] if self.place >= count else ""


def _no_command(at: _Place, commands: Collection[str], options: Mapping[str, Any]) -> str:
    hint = _after_an_option(at, options) or _by_its_looks(at) or _by_its_spelling(at, commands)
    return f"no such command: {at.word}; " + (hint or f"there are: {', '.join(commands)}")


def _after_an_option(at: _Place, options: Mapping[str, Any]) -> str:
    """What was meant by a word behind a flag, or behind the value of an option: its unit, or a second value."""
    last, option = at.before(1), at.before(2)
    if last in options and not _takes_a_value(options[last]):
        return f"{last} takes no value"
    if not _takes_a_value(options.get(option)):
        return ""
    if _A_NUMBER.fullmatch(last) and _A_UNIT.fullmatch(at.word):
        return f'did you mean "{option} {last}{at.word}"?'
    looks = _option_for(at.word)
    if options[option].multiple and (looks == option or (not looks and option != _PROFILE)):
        return f'did you mean "{option} {shell_word(last)} {option} {shell_word(at.word)}"?'
    return ""


def _by_its_looks(at: _Place) -> str:
    """What was meant by a word that looks like the value of an option."""
    option = _option_for(at.word)
    if not at.path:
        return f'did you mean "{option} {at.rest}"?' if option else ""
    command = _LOOKS_AT.get((at.path[0], option))
    return f'did you mean "{at.path[0]} {command} {at.rest}"?' if command else ""


def _by_its_spelling(at: _Place, commands: Collection[str]) -> str:
    """What was meant by a word that is nearly a command."""
    following = [shell_word(word) for word in at.words[at.place + 1 :]]
    lines = [" ".join((*at.path, name, *following)) for name in near_misses(at.word, commands)]
    near = [f'"{line}"' for line in lines]
    return f"did you mean {' or '.join(near)}?" if near else ""


def _option_for(word: str) -> str:
    """The option of the main command whose value a word is by its looks."""
    from pvlvrt_compliance.data.search_path import SUFFIX, known_profiles

    if _A_DEPTH.fullmatch(word):
        return "--sag"
    if _A_CONTROLLER.fullmatch(word):
        return "--controller"
    if PurePath(word).suffix == SUFFIX or word == "all" or word in known_profiles():
        return _PROFILE
    return ""
