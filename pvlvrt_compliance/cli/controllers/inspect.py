"""`pvlvrt-check controllers inspect`."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from pvlvrt_compliance.cli.controllers.shared import Assignments, Mapped, OutOfRange, Spec
from pvlvrt_compliance.cli.telling import say, say_json

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.description import ParameterInfo, Port
    from pvlvrt_compliance.controllers.facts import Facts

_NOTHING = "(nothing)"


def inspect(
    spec: Spec,
    mapping: Mapped = None,
    assignments: Assignments = None,
    allow_out_of_range: OutOfRange = False,
    json: Annotated[bool, typer.Option("--json", metavar="", help="For programs.")] = False,
) -> None:
    """Show a controller's ports, what each is tied to, its parameters and its sample time, and why it cannot be run.

    It is opened as a run opens it; nothing is simulated. Of one that cannot be run what is known is shown all the same.

    Example: pvlvrt-check controllers inspect my_ctrl.py:MyController
    """
    from pvlvrt_compliance.controllers.facts import facts_of
    from pvlvrt_compliance.controllers.inspection import in_words, look_at
    from pvlvrt_compliance.errors import UsageError
    from pvlvrt_compliance.simulation.parameters import own_parameters, parameters_from

    given, others = own_parameters(assignments or ())
    parameters = parameters_from(others)
    found = facts_of(look_at(spec, given, mapping, parameters, allow_out_of_range=allow_out_of_range), parameters)
    if json:
        say_json(found.to_json())
    else:
        say("\n".join(_words(found)))
    if found.faults:
        raise UsageError(in_words(spec, found.faults))


def _words(found: "Facts") -> Iterator[str]:
    from pvlvrt_compliance.controllers.bases import beside

    it = found.description
    of_inputs, of_parameters = (beside(found.bases, where) for where in ("input", "parameter"))
    yield f"{it.name} ({it.kind}), {found.spec}"
    yield f"  SHA-256 {it.digest}"
    yield f"  mapping file: {it.mapping or 'none, ports are tied by their names'}"
    yield f"  {_rates_in_words(found)}"
    yield f"  computation delay {found.computation_delay_samples} sample time(s)"
    inputs = (_port_row(port, of_inputs.get(port.name, "")) for port in it.inputs)
    yield from _table("input", ("unit", "is given", "description"), inputs)
    yield from _table("output", ("unit", "gives", "description"), map(_port_row, it.outputs))
    headings = ("value", "unit", "allowed", "the plant has", "description")
    rows = [_parameter_row(found, parameter, of_parameters.get(parameter.name, "")) for parameter in it.parameters]
    yield from _table("parameter", headings, rows)
    yield from _loose_words(found)


def _rates_in_words(found: "Facts") -> str:
    time_s, rates = found.description.sample_time_s, found.rates
    if not time_s:
        return "sample time not known"
    if rates is None:
        return f"sample time {1e6 * time_s:g} us"
    return (
        f"sample time {1e6 * time_s:g} us: plant step {rates.plant_step_us:g} us,"
        f" {rates.plant_steps_per_sample} steps in a sample time; recorded every {rates.recorded_every_us:g} us"
    )


def _port_row(port: "Port", beside: str = "") -> tuple[str, ...]:
    name = f"{port.name}[{port.width}]" if port.width > 1 else port.name
    notes = [port.mapped_to or _NOTHING, port.note, f"the plant has {beside}" if beside else ""]
    return (name, port.unit, "; ".join(filter(None, notes)), port.description)


def _parameter_row(found: "Facts", parameter: "ParameterInfo", beside: str) -> tuple[str, ...]:
    low, high = parameter.minimum, parameter.maximum
    bounds = [] if low is None and high is None else ["" if x is None else f"{x:g}" for x in (low, high)]
    allowed = " to ".join(bounds) + (" (out of range)" if parameter.name in found.out_of_range else "")
    value = str(found.values[parameter.name])
    return (parameter.name, value, parameter.unit, allowed, beside, parameter.description)


def _table(first: str, headings: Sequence[str], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    """Columns as wide as what they hold; one that holds nothing is left out."""
    rows = list(rows)
    if not rows:
        return
    used = [k for k in range(len(headings) + 1) if k == 0 or any(row[k] for row in rows)]
    lines = [[line[k] for k in used] for line in ((first, *headings), *rows)]
    widths = [max(len(line[k]) for line in lines) for k in range(len(used))]
    yield ""
    for line in lines:
        yield "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()


def _loose_words(found: "Facts") -> Iterator[str]:
    it = found.description
    yield ""
    yield from (f"note: {note}" for note in it.notes)
    for base in found.bases:
        if base.where == "mapping":
            yield f"[bases] of the mapping file: {base.name} = {base.value:g}; the plant has {base.in_words()}"
    for side, ports in (("inputs", found.unmapped_inputs), ("outputs", found.unmapped_outputs)):
        if ports:
            yield f"still unmapped: {side} {', '.join(ports)}"
    if found.missing_commands:
        from pvlvrt_compliance.controllers.mapping.commands import missing_words
        from pvlvrt_compliance.controllers.mapping.telling import reasons

        yield f"cannot be run yet: {missing_words(found.missing_commands, reasons(it.outputs))}"
    if found.faults:
        yield "cannot be run: the error says why"
    if found.is_ready:
        yield "ready to run: every input is given something, and all commands are given"
