"""`pvlvrt-check config ...`: look at the settings that hold."""

import typer

from pvlvrt_compliance.cli.config.show import show

app = typer.Typer(
    help="Settings: see what holds, and where it comes from.\n\nExample: pvlvrt-check config show",
    rich_markup_mode="rich",
)


@app.callback()
def config() -> None:
    """Settings: see what holds, and where it comes from."""


app.command()(show)
