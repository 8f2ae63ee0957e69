"""`pvlvrt-check profiles ...`: what grid codes there are, what they say, and whether a file is one."""

import typer

from pvlvrt_compliance.cli.profiles.check import check
from pvlvrt_compliance.cli.profiles.listing import list_profiles
from pvlvrt_compliance.cli.profiles.new import new
from pvlvrt_compliance.cli.profiles.plot import plot
from pvlvrt_compliance.cli.profiles.schema import schema
from pvlvrt_compliance.cli.profiles.show import show

app = typer.Typer(
    help="Grid codes: list, read, draw, check and begin them.\n\nExample: pvlvrt-check profiles list",
    rich_markup_mode="rich",
)
app.command("list")(list_profiles)
for command in (show, plot, check, schema, new):
    app.command()(command)
