"""Entry point of the program: says at once what needs no typer, and leaves everything else to `main`.

Importing typer takes five times as long as Python's own start, and drawing a help another ten.
"""

import sys
from collections.abc import Sequence

from pvlvrt_compliance.cli.at_once import HELP, VERSION, version
from pvlvrt_compliance.cli.completion.answering import is_asked
from pvlvrt_compliance.cli.flushing import printed


def main() -> None:
    """Run as a program."""
    arguments = sys.argv[1:]
    if arguments == [VERSION] and not is_asked():
        sys.exit(printed(f"{version()}\n"))
    if _is_of_help(arguments) and not is_asked():
        _help(arguments)
    else:
        _everything()


def _everything() -> None:
    from pvlvrt_compliance.cli.main import main as everything

    everything()


def _is_of_help(arguments: Sequence[str]) -> bool:
    """Whether a line asks for the help of a command, and has nothing else that an answer could depend on."""
    options = [word for word in arguments if word.startswith("-")]
    return len(options) == 1 and options[0] in HELP and arguments[-1] in HELP


def _help(arguments: Sequence[str]) -> None:
    """Show the help that is kept; without one have typer draw it, and keep that."""
    from pvlvrt_compliance.cache import keep, look_up
    from pvlvrt_compliance.cli.kept_help import name_of, noted
    from pvlvrt_compliance.compiled.notes import tell_in_lines

    name = name_of(arguments)
    if not name:
        _everything()
        return
    tell_in_lines()
    found = look_up(name)
    if found is not None:
        sys.exit(printed(found))
    with noted() as said:
        try:
            _everything()
        except SystemExit as end:
            if end.code == 0:
                keep(name, b"".join(said))
            raise
