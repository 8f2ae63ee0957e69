"""`pvlvrt-check controllers inspect`."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from pvlvrt_compliance.cli.telling import say, say_json

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.description import ParameterInfo, Port, Value
    from pvlvrt_compliance.controllers.facts import Facts

_NOTHING = "(nothing)"


def inspect(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="As for --controller.", show_default=False)],
    mapping: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Ties its ports to the plant. Default: NAME.mapping.toml beside it."),
    ] = None,
    assignments: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A parameter, as of the main command; repeatable."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", metavar="", help="For programs.")] = False,
) -> None:
    """Show a controller's ports, what each is tied to, its parameters and its sample time; nothing is simulated.

    Example: pvlvrt-check controllers inspect my_ctrl.py:MyController
    """
    from pvlvrt_compliance.controllers.facts import facts_of
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.simulation.parameters import own_parameters, parameters_from

    given, others = own_parameters(assignments or ())
    parameters = parameters_from(others)
    found = facts_of(ForeignSimulator(spec, given, mapping, parameters=parameters), parameters)
    if json:
        say_json(found.to_json())
        return
    say("\n".join(_words(found)))


def _words(found: "Facts") -> Iterator[str]:
    it, rates = found.description, found.rates
    yield f"{it.name} ({it.kind}), {found.spec}"
    yield f"  SHA-256 {it.digest}"
    yield f"  mapping file: {it.mapping or 'none, ports are tied by their names'}"
    yield (
        f"  sample time {1e6 * it.sample_time_s:g} us: plant step {rates.plant_step_us:g} us,"
        f" {rates.plant_steps_per_sample} steps in a sample time; recorded every {rates.recorded_every_us:g} us"
    )
    yield f"  computation delay {found.computation_delay_samples} sample time(s)"
    yield from _table("input", ("unit", "is given", "description"), map(_port_row, it.inputs))
    yield from _table("output", ("unit", "gives", "description"), map(_port_row, it.outputs))
    headings = ("value", "unit", "allowed", "description")
    rows = (_parameter_row(parameter, found.values[parameter.name]) for parameter in it.parameters)
    yield from _table("parameter", headings, rows)
    yield from _loose_words(found)


def _port_row(port: "Port") -> tuple[str, ...]:
    name = f"{port.name}[{port.width}]" if port.width > 1 else port.name
    note = f"; {port.note}" if port.note else ""
    return (name, port.unit, (port.mapped_to or _NOTHING) + note, port.description)


def _parameter_row(parameter: "ParameterInfo", value: "Value") -> tuple[str, ...]:
    low, high = parameter.minimum, parameter.maximum
    bounds = [] if low is None and high is None else ["" if x is None else f"{x:g}" for x in (low, high)]
    return (parameter.name, str(value), parameter.unit, " to ".join(bounds), parameter.description)


def _table(first: str, headings: Sequence[str], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    lines = [(first, *headings), *rows]
    if len(lines) == 1:
        return
    widths = [max(len(line[k]) for line in lines) for k in range(len(headings) + 1)]
    yield ""
    for line in lines:
        yield "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()


def _loose_words(found: "Facts") -> Iterator[str]:
    yield ""
    yield from (f"note: {note}" for note in found.description.notes)
    for side, ports in (("inputs", found.unmapped_inputs), ("outputs", found.unmapped_outputs)):
        if ports:
            yield f"still unmapped: {side} {', '.join(ports)}"
    if found.missing_commands:
        yield f"cannot be run yet: no output gives {', '.join(found.missing_commands)}"
    if found.is_ready:
        yield "ready to run: every input is given something, and all commands are given"
