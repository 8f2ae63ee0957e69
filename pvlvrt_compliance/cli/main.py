"""Entry point: reads the command line, turns every error into one clear line and an exit status."""

import sys
import traceback
from collections.abc import Sequence
from typing import Any

import typer

from pvlvrt_compliance.cli import controllers, profiles
from pvlvrt_compliance.cli.check import check
from pvlvrt_compliance.cli.schema import schema
from pvlvrt_compliance.compiled.notes import tell_in_lines
from pvlvrt_compliance.errors import PvlvrtError, UsageError

USAGE_STATUS = 2
CRASHED_STATUS = 3
INTERRUPTED_STATUS = 130

# What typer raises for an option it does not know or cannot read. Its own name has moved between versions.
_CommandLineError: Any = typer.BadParameter.__bases__[0]

app = typer.Typer(
    name="pvlvrt-check",
    add_completion=False,
    rich_markup_mode="rich",
    no_args_is_help=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.callback(invoke_without_command=True)(check)
app.command()(schema)
app.add_typer(profiles.app, name="profiles")
app.add_typer(controllers.app, name="controllers")


def run(arguments: Sequence[str]) -> int:
    """Run the command with these arguments and return its exit status."""
    try:
        status = typer.main.get_command(app).main(
            args=_with_explicit_pair(arguments),
            prog_name="pvlvrt-check",
            standalone_mode=False,
            obj=("pvlvrt-check", *arguments),
        )
    except _CommandLineError as error:
        return _complain(error.format_message())
    except PvlvrtError as error:
        return _complain(str(error))
    except (typer.Abort, KeyboardInterrupt):
        print("interrupted", file=sys.stderr)
        return INTERRUPTED_STATUS
    except SystemExit:
        # rich and typer end the program so when the reader of stdout has gone (for instance `| head`).
        return 0
    except OSError as error:
        return _complain(str(error))
    return status if isinstance(status, int) else 0


def main() -> None:
    """Run as a program."""
    tell_in_lines()
    try:
        status = run(sys.argv[1:])
    except Exception:
        # Python's own status for a crash is 1, which means here that a check failed.
        traceback.print_exc()
        status = CRASHED_STATUS
    sys.exit(status)


def _with_explicit_pair(arguments: Sequence[str]) -> list[str]:
    """Read ``--two-phase ab`` and ``--two-phase=ab`` as ``--two-phase --phases ab``: typer has no optional values."""
    given: list[str] = []
    for argument in arguments:
        flag, equals, pair = argument.partition("=")
        if given and given[-1] == "--two-phase" and not argument.startswith("-"):
            given += ["--phases", argument]
        elif flag == "--two-phase" and equals:
            given += ["--two-phase", "--phases", pair]
        else:
            given.append(argument)
    if sum(argument.partition("=")[0] == "--phases" for argument in given) > 1:
        raise UsageError("--phases: given twice (--two-phase PAIR names the phases, too)")
    return given


def _complain(message: str) -> int:
    print(f"pvlvrt-check: {message}", file=sys.stderr)
    return USAGE_STATUS


if __name__ == "__main__":
    main()
