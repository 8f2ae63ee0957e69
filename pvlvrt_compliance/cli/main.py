"""Reads the command line with typer, turns every error into one clear line and an exit status."""

import gc
import sys
from collections.abc import Sequence
from contextlib import suppress
from copy import copy
from typing import Any

import typer

from pvlvrt_compliance.cli import baseline, config, controllers, profiles
from pvlvrt_compliance.cli.at_once import HELP
from pvlvrt_compliance.cli.check import check
from pvlvrt_compliance.cli.compare import compare
from pvlvrt_compliance.cli.completion.answering import answer, is_asked
from pvlvrt_compliance.cli.completion.command import completion
from pvlvrt_compliance.cli.completion.scripts import PROGRAM
from pvlvrt_compliance.cli.environment import forget_what_is_no_width
from pvlvrt_compliance.cli.flushing import UNWRITTEN_STATUS, flushed, unwritten
from pvlvrt_compliance.cli.guarding import guarded
from pvlvrt_compliance.cli.merge import merge
from pvlvrt_compliance.cli.schema import schema
from pvlvrt_compliance.cli.telling import say_aside, tell
from pvlvrt_compliance.cli.typed import last_of_each_flag, read_what_is_given, understood
from pvlvrt_compliance.compiled.notes import tell_in_lines
from pvlvrt_compliance.controllers.process.command import become_the_command, leave, status_of, words_of
from pvlvrt_compliance.errors import PvlvrtError, UnfinishedError, stop_behind

USAGE_STATUS = 2
CRASHED_STATUS = 3

# Of what a start makes, next to nothing is ever to be collected; Python would look for it two hundred times.
_COLLECTIONS = (20_000, 20, 10)

# What typer raises for an option it does not know or cannot read. Its own name has moved between versions.
_CommandLineError: Any = typer.BadParameter.__bases__[0]

_SETTINGS: dict[str, Any] = {"help_option_names": list(HELP)}

app = typer.Typer(
    name=PROGRAM,
    add_completion=False,  # typer's writes into start-up files; "completion" prints, and asks as typer's does
    rich_markup_mode="rich",
    no_args_is_help=False,
    context_settings=_SETTINGS,
)
app.callback(invoke_without_command=True)(check)
app.command()(compare)
app.command()(merge)
app.command()(schema)
app.command()(completion)
app.add_typer(profiles.app, name="profiles")
app.add_typer(controllers.app, name="controllers")
app.add_typer(config.app, name="config")
app.add_typer(baseline.app, name="baseline")


def run(arguments: Sequence[str]) -> int:
    """Run the command with these arguments and return its exit status."""
    forget_what_is_no_width()
    with guarded():
        return _run(arguments)


def _run(arguments: Sequence[str]) -> int:
    if is_asked():
        return answer(typer.main.get_command(app))
    try:
        command = _commands_for(arguments)
        called, words, rest = _called(command, understood(command, arguments))
        rest = last_of_each_flag(called, rest)
        read_what_is_given(called, rest)
        status = called.main(
            args=rest,
            prog_name=" ".join([PROGRAM, *words]),
            standalone_mode=False,
            obj=(PROGRAM, *arguments),
            **_SETTINGS,
        )
    except _CommandLineError as error:
        return _complain(error.format_message())
    except (PvlvrtError, OSError) as error:
        return _complain_of(error)
    except SystemExit:
        # rich and typer end the program so when the reader of stdout has gone (for instance `| head`).
        return 0
    except BaseException as end:
        stop = end if isinstance(end, typer.Abort) else stop_behind(end)
        if stop is None:
            raise
        tell(words_of(stop))
        return status_of(stop)
    return status if isinstance(status, int) else 0


def _commands_for(arguments: Sequence[str]) -> Any:
    """The commands among which the called one is: all of them, or those that the first word names.

    Typer takes the signature of every function apart, which is most of what a short command does. Where the first word
    names a command, no option stands before it and no other is asked for.
    """
    word = arguments[0] if arguments else ""
    groups = [group for group in app.registered_groups if group.name == word]
    commands = [known for known in app.registered_commands if known.callback and known.callback.__name__ == word]
    if not groups and not commands:
        return typer.main.get_command(app)
    part = copy(app)
    part.registered_groups, part.registered_commands, part.registered_callback = groups, commands, None
    return typer.main.get_group(part)


def _called(command: Any, words: list[str]) -> tuple[Any, list[str], list[str]]:
    """The command that words are for, those that call it, and the rest.

    Nothing stands before a command (`understood`), so the options of the groups above it need not be read: for those
    of the main command alone typer loads pydantic, and makes a validator each.
    """
    path: list[str] = []
    while words and words[0] in getattr(command, "commands", {}):
        command = command.commands[words[0]]
        path.append(words[0])
        words = words[1:]
    return command, path, words


def main() -> None:
    """Run as a program."""
    gc.set_threshold(*_COLLECTIONS)
    tell_in_lines()
    become_the_command()
    try:
        status = flushed(run(sys.argv[1:]))
    except BaseException as end:
        status = _ended_by(end)
    leave(status)


def _ended_by(end: BaseException) -> int:
    """Say what has gone wrong in the program itself, and only that: of a signal the status says all."""
    if stop := stop_behind(end):
        return status_of(stop)
    # Python's own status for a crash is 1, which means here that a check failed.
    import traceback

    with suppress(OSError), guarded():
        say_aside("".join(traceback.format_exception(end)).removesuffix("\n"))
    return CRASHED_STATUS


def _complain_of(error: PvlvrtError | OSError) -> int:
    if isinstance(error, UnfinishedError):
        return _complain(str(error), UNWRITTEN_STATUS)
    if isinstance(error, OSError) and error.filename is None:  # of all that is written, one stream has no name
        return _complain(unwritten(error), UNWRITTEN_STATUS)
    return _complain(f"{error.filename}: {error.strerror}" if isinstance(error, OSError) else str(error))


def _complain(message: str, status: int = USAGE_STATUS) -> int:
    tell(message)
    return status


if __name__ == "__main__":
    main()
