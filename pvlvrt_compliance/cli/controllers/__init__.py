"""`pvlvrt-check controllers ...`: look at a controller of one's own, begin one, get the header of the C interface."""

import typer

from pvlvrt_compliance.cli.controllers.header import header
from pvlvrt_compliance.cli.controllers.inspect import inspect
from pvlvrt_compliance.cli.controllers.new import new

app = typer.Typer(
    help="Controllers of your own: look at one, begin one.\n\nExample: pvlvrt-check controllers new my-controller",
    rich_markup_mode="rich",
)
for command in (inspect, new, header):
    app.command()(command)
