"""`pvlvrt-check controllers ...`: look at a controller of one's own, begin one, feed one; the header for C."""

import typer

from pvlvrt_compliance.cli.controllers.header import header
from pvlvrt_compliance.cli.controllers.inspect import inspect
from pvlvrt_compliance.cli.controllers.new import new
from pvlvrt_compliance.cli.controllers.replay import replay

app = typer.Typer(
    help="Controllers of your own: look at one, begin one.\n\nExample: pvlvrt-check controllers new my-controller",
    rich_markup_mode="rich",
)
for command in (inspect, new, replay, header):
    app.command()(command)
