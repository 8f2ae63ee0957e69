"""`pvlvrt-check completion`."""

from typing import Annotated

import typer

from pvlvrt_compliance.cli.completion.scripts import SHELLS, script_for
from pvlvrt_compliance.cli.telling import hand_over


def completion(
    shell: Annotated[
        str,
        typer.Argument(
            metavar="SHELL",
            help=f"{', '.join(SHELLS[:-1])} or {SHELLS[-1]}.",
            show_default=False,
            autocompletion=lambda: [(shell, "") for shell in SHELLS],
        ),
    ],
) -> None:
    """Print the script that completes commands, options, profiles, tests and parameters in your shell.

    Example, in ~/.bashrc: eval "$(pvlvrt-check completion bash)"
    """
    hand_over(script_for(shell))
