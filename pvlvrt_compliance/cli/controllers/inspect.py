"""`pvlvrt-check controllers inspect`."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from pvlvrt_compliance.scenario.parameters import Parameters
    from pvlvrt_compliance.simulation.doors.base import Port
    from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator

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
    from pvlvrt_compliance.scenario.parameters import own_parameters, parameters_from
    from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator

    given, others = own_parameters(assignments or ())
    parameters = parameters_from(others)
    found = _facts(ForeignSimulator(spec, given, mapping), given, parameters)
    if json:
        from json import dumps

        print(dumps(found, indent=2))
        return
    print("\n".join(_words(found)))


def _facts(simulator: "ForeignSimulator", given: dict[str, Any], parameters: "Parameters") -> dict[str, Any]:
    """All that is known, as plain data."""
    from pvlvrt_compliance.simulation.doors.mapping import missing_commands
    from pvlvrt_compliance.simulation.sample_time import rates_of

    description = simulator.description
    rates = rates_of(description.sample_time_s, parameters)
    data = description.to_json()
    for parameter in data["parameters"]:
        parameter["default"] = parameter["value"]
        parameter["value"] = given.get(parameter["name"], parameter["default"])
    return {
        "spec": simulator.spec,
        **{key: data[key] for key in ("kind", "name", "digest", "sample_time_s")},
        "plant_step_us": rates.plant_step_us,
        "plant_steps_per_sample": rates.steps * rates.periods,
        "recorded_every_us": rates.plant_step_us * rates.steps * rates.thinning,
        "computation_delay_samples": parameters.controller.computation_delay_samples,
        "mapping": simulator.mapping(),
        **{key: data[key] for key in ("inputs", "outputs", "parameters", "notes")},
        "unmapped_inputs": _loose(description.inputs),
        "unmapped_outputs": _loose(description.outputs),
        "missing_commands": list(missing_commands(description.outputs)),
    }


def _loose(ports: "Sequence[Port]") -> list[str]:
    return [port.name for port in ports if port.is_loose]


def _words(found: dict[str, Any]) -> Iterator[str]:
    yield f"{found['name']} ({found['kind']}), {found['spec']}"
    yield f"  SHA-256 {found['digest']}"
    yield f"  mapping file: {found['mapping'] or 'none, ports are tied by their names'}"
    yield (
        f"  sample time {1e6 * found['sample_time_s']:g} us: plant step {found['plant_step_us']:g} us,"
        f" {found['plant_steps_per_sample']} steps in a sample time; recorded every {found['recorded_every_us']:g} us"
    )
    yield f"  computation delay {found['computation_delay_samples']} sample time(s)"
    yield from _table("input", ("unit", "is given", "description"), map(_port_row, found["inputs"]))
    yield from _table("output", ("unit", "gives", "description"), map(_port_row, found["outputs"]))
    headings = ("value", "unit", "allowed", "description")
    yield from _table("parameter", headings, map(_parameter_row, found["parameters"]))
    yield from _loose_words(found)


def _port_row(port: dict[str, Any]) -> tuple[str, ...]:
    name = f"{port['name']}[{port['width']}]" if port["width"] > 1 else port["name"]
    note = f"; {port['note']}" if port["note"] else ""
    return (name, port["unit"], (port["mapped_to"] or _NOTHING) + note, port["description"])


def _parameter_row(parameter: dict[str, Any]) -> tuple[str, ...]:
    low, high = parameter["minimum"], parameter["maximum"]
    bounds = [] if low is None and high is None else ["" if x is None else f"{x:g}" for x in (low, high)]
    return (
        parameter["name"],
        str(parameter["value"]),
        parameter["unit"],
        " to ".join(bounds),
        parameter["description"],
    )


def _table(first: str, headings: Sequence[str], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    lines = [(first, *headings), *rows]
    if len(lines) == 1:
        return
    widths = [max(len(line[k]) for line in lines) for k in range(len(headings) + 1)]
    yield ""
    for line in lines:
        yield "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()


def _loose_words(found: dict[str, Any]) -> Iterator[str]:
    yield ""
    yield from (f"note: {note}" for note in found["notes"])
    for side in ("inputs", "outputs"):
        if found[f"unmapped_{side}"]:
            yield f"still unmapped: {side} {', '.join(found[f'unmapped_{side}'])}"
    if found["missing_commands"]:
        yield f"cannot be run yet: no output gives {', '.join(found['missing_commands'])}"
    elif not found["unmapped_inputs"]:
        yield "ready to run: every input is given something, and all commands are given"
