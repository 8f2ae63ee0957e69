"""Every option, argument and parameter of the command, from the tables that the command itself is made of.

What is added there is covered here without a line more: a value that is known to be good is only needed for a command
line to come far.
"""

from collections.abc import Iterator
from random import Random
from typing import Any, NamedTuple

import typer

from pvlvrt_compliance.cli.main import app
from pvlvrt_compliance.simulation.parameters import Parameters, parameter_names
from tests.hostile import values

GOOD: dict[str, tuple[str, ...]] = {
    "--profile": ("iec61400-21", "nerc-prc-029", "spain-q-curve", "ours.toml", "all"),
    "--controller": ("bundled", "ours.py:Controller", "stdio:true", "ours.so", "ours.fmu"),
    "--mapping": ("ours.mapping.toml",),
    "--sag": ("50%", "0.9", "0%", "100%"),
    "--phases": ("abc", "a", "bc", "ca"),
    "--sag-type": tuple("ABCDEFG"),
    "--duration": ("20ms", "0.1s", "500ms"),
    "--point-on-wave": ("0", "90deg", "360"),
    "--irradiance": ("1000", "800W/m2", "0"),
    "--frequency": ("50", "60Hz", "49.5"),
    "--temperature": ("25", "45C", "-40"),
    "--scr": ("10", "2.5", "0.6"),
    "--xr": ("10", "0.1"),
    "--fidelity": ("averaged", "switched"),
    "--transformer": ("Dyn11", "Yy0", "YNd1"),
    "--events": ("ours.events.toml",),
    "--set": ("controller.pr_integral_gain=0.2", "simulation.settling_s=0.1"),
    "--test": ("VD3*", "*", "sag-50pct-abc"),
    "--skip": ("VD1*",),
    "--check": ("reactive_support", "dc_ripple"),
    "--shard": ("1/2", "2/2"),
    "--jobs": ("1", "auto"),
    "--reuse": ("out/records",),
    "--reuse-size": ("2GB", "500MB"),
    "--output": ("out",),
    "--waveforms": ("all", "failed", "none"),
    "--format": ("badge", "github", "gitlab", "markdown", "verdicts"),
    "--language": ("en", "es"),
    "--report-field": ("client=Solar Ltd", "remark=a", "logo=ours.png"),
    "--baseline": ("ours.txt",),
    "--baseline-tolerance": ("1%", "0.5"),
    "--config": ("ours.config.toml",),
    "--fail-on": ("verdict", "margin:5%"),
    "--kind": ("python", "c", "fmu", "program"),
    "--include": ("iec61400-21",),
    "--results": ("results.json",),
    "--reason": ("a ticket",),
}
"""Values of options that are of use, by the first name of each; of what is not here, an example is not known."""

ONLY: dict[str, tuple[str, ...]] = {
    "--cluster": (
        "", " ", "tcp://", "tls://", "ws://", "://", "inproc://x", "ucx://x", "http://x", "http://[", "tcp//x", "0",
        "tcp://127.0.0.1", "tcp://127.0.0.1:1e3", "tcp://[::1", "tcp://::::", "::1", "-1", "tcp://a:b", "../x",
        "/dev/zero", f"tcp://{values.DIGITS}", "x" * 5000, *values.CONTROL, *values.RUNNER, *values.NO_TEXT,
    ),
}  # fmt: skip
"""What an option is given and nothing else: an address that is one would be called, and who knows who answers."""

NEVER = {"--show-completion", "--install-completion"}
"""What starts things that are not this process's to end."""

ARGUMENTS: dict[tuple[str, ...], tuple[str, ...]] = {
    (): ("--profile", "iec61400-21"),
    ("compare",): ("results.json", "results.json"),
    ("merge",): ("part1", "part2"),
    ("profiles", "show"): ("iec61400-21",),
    ("profiles", "plot"): ("iec61400-21",),
    ("profiles", "check"): ("iec61400-21",),
    ("profiles", "new"): ("ours-new",),
    ("controllers", "inspect"): ("ours.py:Controller",),
    ("controllers", "new"): ("new",),
    ("baseline", "update"): ("ours.txt",),
    ("completion",): ("bash",),
}
"""What each command is given before anything is damaged."""


class Command(NamedTuple):
    """A command, by its words, with what it takes."""

    words: tuple[str, ...]
    options: tuple[Any, ...]


def commands() -> list[Command]:
    """All commands that run; a group is none."""
    return list(_commands(typer.main.get_command(app), ()))


def _commands(command: Any, words: tuple[str, ...]) -> Iterator[Command]:
    if not words or not hasattr(command, "commands"):
        yield Command(words, tuple(x for x in command.params if x.param_type_name == "option"))
    for name, inner in getattr(command, "commands", {}).items():
        yield from _commands(inner, (*words, name))


def words_of(option: Any, rng: Random, good: float = 0.5) -> list[str]:
    """An option as it may be typed, with a good value or the worst."""
    name = rng.choice((*option.opts, *option.secondary_opts))
    if option.is_flag or option.count:
        return [name] if rng.random() < 0.9 else [f"{name}={values.argument(rng)}"]
    known = GOOD.get(option.opts[0], ())
    if option.opts[0] in ONLY:
        value = rng.choice(ONLY[option.opts[0]])
    elif known and rng.random() < good:
        value = rng.choice(known)
    elif known and rng.random() < 0.4:
        value = _altered(rng.choice(known), rng)
    else:
        value = values.argument(rng)
    if option.opts[0] in ("--set", "--report-field") and rng.random() < 0.3:
        value = f"{rng.choice(('controller', 'plant', 'client', values.argument(rng)))}={value}"
    return [f"{name}={value}"] if rng.random() < 0.3 else [name, value]


def _altered(value: str, rng: Random) -> str:
    at = rng.randrange(len(value) + 1)
    return value[:at] + values.argument(rng)[:200] + value[at + rng.randrange(2) :]


def assignment(rng: Random, mild: bool = False) -> str:
    """A parameter with a value near its own, or with the worst."""
    name = rng.choice(parameter_names())
    group, _, key = name.partition(".")
    own = getattr(getattr(Parameters(), group), key)
    if isinstance(own, bool) and mild:
        return f"{name}={str(rng.random() < 0.5).lower()}"
    if isinstance(own, int | float) and (mild or rng.random() < 0.4):
        near = own * rng.choice((0.9, 0.99, 1.0, 1.01, 1.1)) if mild else values.nudged(rng, own)
        return f"{name}={round(near) if isinstance(own, int) else near}"
    if mild:
        return f"{name}={str(own).replace(chr(39), chr(34)) if not isinstance(own, str | None) else own or 'null'}"
    spelled = rng.choice((values.number, values.number, values.argument))(rng)
    many = rng.choice((spelled, spelled, spelled, f"[{spelled},{spelled},{spelled}]", "[" * 5000, f'"{spelled}"', "{}"))
    return rng.choice((f"{name}={many}", f"{name}={many}", f"{name} = {many}", f"{name[:-1]}={many}", many))
