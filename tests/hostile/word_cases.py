"""Cases that are about words: options, parameters, variables."""

from random import Random
from typing import Any

from pvlvrt_compliance.cli.completion.scripts import ASKED_BY
from tests.hostile import options, values
from tests.hostile.case import OUT, SHORT, Case, commands


def options_case(rng: Random) -> Case:
    """Any options of any command, alone or together."""
    main, *others = commands()
    command = main if rng.random() < 0.6 else rng.choice(others)
    given = list(options.ARGUMENTS.get(command.words, ()))
    taken = [option for option in command.options if option.opts[0] not in options.NEVER]
    for option in rng.sample(taken, min(len(taken), rng.choice((1, 1, 2, 3, 6)))):
        given += options.words_of(option, rng)
    if given and rng.random() < 0.15:
        given[rng.randrange(len(given))] = values.argument(rng)
    if rng.random() < 0.1:
        rng.shuffle(given)
    if command is main:
        given.append("--list")
    return _bounded("options", (*command.words, *given))


def _bounded(kind: str, arguments: tuple[str, ...], **more: Any) -> Case:
    """A case that writes into its own folder only, whatever its options say."""
    made, writes = [], list(Case._field_defaults["writes"])
    behind = ""
    for word in arguments:
        name, equals, value = word.partition("=")
        if behind in ("--output", "--reuse", "-o"):
            word = _inside(word)  # noqa: PLW2901
            writes.append(word)
        elif equals and name in ("--output", "--reuse"):
            word = f"{name}={_inside(value)}"  # noqa: PLW2901
            writes.append(_inside(value))
        made.append(word)
        behind = word
    if arguments[:2] in (("profiles", "new"), ("controllers", "new"), ("profiles", "plot"), ("baseline", "update")):
        writes.append(".")
        made = [_inside(word) if word.startswith(("/", "..", "~", "file:")) else word for word in made]
    return Case(kind, tuple(made), writes=tuple(writes), **more)


def _inside(path: str) -> str:
    return path.replace("..", "dots").lstrip("/~")


def parameters(rng: Random) -> Case:
    """Any parameters of a run."""
    given = [word for _ in range(rng.choice((1, 1, 1, 2, 5))) for word in ("--set", options.assignment(rng))]
    given += ("--controller", "ours.py:Controller") if rng.random() < 0.1 else ()
    return Case(
        "parameters", ("--profile", "iec61400-21", *SHORT, "--list", *(word.replace("\x00", "") for word in given))
    )


def environment(rng: Random) -> Case:
    """Variables that hold settings, and others that a start reads."""
    names = [option.opts[0] for option in commands()[0].options if option.opts[0] not in options.NEVER]
    found = {}
    for _ in range(rng.choice((1, 2, 4))):
        name = rng.choice(names)
        known = options.GOOD.get(name, ())
        value = rng.choice(known) if known and rng.random() < 0.5 else values.argument(rng)
        value = rng.choice(options.ONLY.get(name, (value,)))
        found[f"PVLVRT_{name.lstrip('-').replace('-', '_').upper()}"] = value
    others = (
        "SOURCE_DATE_EPOCH",
        "PVLVRT_PROFILES",
        "COLUMNS",
        "LINES",
        "TERMINAL_WIDTH",
        "NO_COLOR",
        "FORCE_COLOR",
        "PVLVRT_X",
        "LANG",
        "TERM",
    )
    if rng.random() < 0.4:
        found[rng.choice(others)] = values.argument(rng)
    if rng.random() < 0.1:
        found["GITHUB_ACTIONS"] = "true"
    if "PVLVRT_OUTPUT" in found:
        found["PVLVRT_OUTPUT"] = OUT
    head = rng.choice((("config", "show"), ("--list",), ("--profile", "iec61400-21", "--list"), ("profiles", "list")))
    return Case("environment", head, environment={name: value[:100_000] for name, value in found.items()})


def completion(rng: Random) -> Case:
    """A line that a shell asks about."""
    line = rng.choice(("", "--profile ", "--profile x --test ", "profiles show ", "--set ", "compare "))
    found = {
        "COMP_WORDS": f"pvlvrt-check {line}{values.argument(rng) if rng.random() < 0.8 else ''}",
        "COMP_CWORD": rng.choice(("1", "2", "3", values.argument(rng))),
        ASKED_BY: rng.choice(("complete_bash", "complete_zsh", "complete_fish", values.argument(rng))),
    }
    return Case("completion", (), environment={name: value[:50_000] for name, value in found.items()})
