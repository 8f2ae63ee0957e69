"""Entry point: reads the command line, turns every error into one clear line and an exit status."""

import sys
from collections.abc import Sequence
from typing import Any

import typer

from pvlvrt_compliance.cli.check import check
from pvlvrt_compliance.cli.schema import schema
from pvlvrt_compliance.errors import PvlvrtError

USAGE_STATUS = 2
INTERRUPTED_STATUS = 130

PAIRS = ("ab", "bc", "ca")

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


def run(arguments: Sequence[str]) -> int:
    """Run the command with these arguments and return its exit status."""
    try:
        status = typer.main.get_command(app).main(
            args=_with_explicit_pair(arguments), prog_name="pvlvrt-check", standalone_mode=False
        )
    except _CommandLineError as error:
        return _complain(error.format_message())
    except PvlvrtError as error:
        return _complain(str(error))
    except (typer.Abort, KeyboardInterrupt):
        print("interrupted", file=sys.stderr)
        return INTERRUPTED_STATUS
    except BrokenPipeError:
        # The reader of stdout has gone (for instance `| head`); what it did not read is no error of ours.
        sys.stderr.close()
        return 0
    return status if isinstance(status, int) else 0


def main() -> None:
    """Run as a program."""
    sys.exit(run(sys.argv[1:]))


def _with_explicit_pair(arguments: Sequence[str]) -> list[str]:
    """Read ``--two-phase ab`` and ``--two-phase=ab`` as ``--two-phase --phases ab``: typer has no optional values."""
    given: list[str] = []
    for argument in arguments:
        flag, equals, pair = argument.partition("=")
        if given and given[-1] == "--two-phase" and argument in PAIRS:
            given += ["--phases", argument]
        elif flag == "--two-phase" and equals:
            given += ["--two-phase", "--phases", pair]
        else:
            given.append(argument)
    return given


def _complain(message: str) -> int:
    print(f"pvlvrt-check: {message}", file=sys.stderr)
    return USAGE_STATUS


if __name__ == "__main__":
    main()
