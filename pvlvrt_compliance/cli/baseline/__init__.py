"""`pvlvrt-check baseline ...`: the file of known failures that a team commits."""

import typer

from pvlvrt_compliance.cli.baseline.update import update

app = typer.Typer(
    help="Known failures: the file that --baseline holds a run against.\n\nExample: pvlvrt-check baseline update",
    rich_markup_mode="rich",
    no_args_is_help=True,
)


@app.callback()
def _baseline() -> None:
    """One command alone would otherwise be the whole of it."""


app.command()(update)
