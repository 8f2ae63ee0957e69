"""Options of the main command: a file a panel of the help, an entry an option, by the field that it sets."""

import inspect
from collections.abc import Callable, Collection, Mapping
from typing import Annotated, Any

import typer

from pvlvrt_compliance.cli.completion.asking import completer
from pvlvrt_compliance.cli.options import files, output, run, sag, selection, setting, speed
from pvlvrt_compliance.cli.options.option import Option
from pvlvrt_compliance.settings.setting import Setting

OPTIONS: dict[str, Option] = {
    **run.OPTIONS,
    **sag.OPTIONS,
    **setting.OPTIONS,
    **selection.OPTIONS,
    **speed.OPTIONS,
    **output.OPTIONS,
    **files.OPTIONS,
}
"""All of them, in the order of the help."""

_OF_THE_MOMENT = (*files.OPTIONS, "debug", "list_only", "list_json")
"""What nobody writes down: it is meant for one call."""

_HOW = ("jobs", "cluster", "settle_once")
"""What says how a run is made, not what it finds (`study.job.HOW`)."""

SETTINGS: tuple[Setting, ...] = tuple(
    Setting(field, option.names[0], option.kind, option.metavar, field in _HOW)
    for field, option in OPTIONS.items()
    if field not in _OF_THE_MOMENT
)
"""The options that may stand in a file of settings and in the environment, too."""

_TAKEN_BACK = "no_"


def spelled(field: str) -> str:
    """The option that sets a field, as messages name it."""
    return OPTIONS[field].names[0] if field in OPTIONS else f"--{field.replace('_', '-')}"


def takes_options(command: Callable[..., Any], *, shown: Collection[str] = tuple(OPTIONS)) -> Callable[..., Any]:
    """Give a function ``(**given)`` the options, but those that its signature has itself; its help has some of them.

    typer reads the signature of a function; this one is made of the table.
    """
    return takes(OPTIONS, shown)(command)


def takes(
    options: Mapping[str, Option], shown: Collection[str] | None = None
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """The same with some of the options, or with others of the same fields; all are shown unless some are named."""
    return lambda command: _with_options(command, options, options if shown is None else shown)


def _with_options(
    command: Callable[..., Any], options: Mapping[str, Option], shown: Collection[str]
) -> Callable[..., Any]:
    own = inspect.signature(command).parameters
    named = [parameter for parameter in own.values() if parameter.kind is not parameter.VAR_KEYWORD]
    others = {name: option for name, option in options.items() if name not in own}
    made = [_parameter(name, _annotation(option, name not in shown)) for name, option in others.items()]
    made += [_parameter(f"{_TAKEN_BACK}{name}", _taking_back(of)) for name, of in others.items() if of.kind is bool]
    signature = inspect.Signature([*named, *made])
    command.__signature__ = signature  # type: ignore[attr-defined]
    command.__annotations__ = {name: parameter.annotation for name, parameter in signature.parameters.items()}
    return command


def given_options(values: Mapping[str, Any], first: Collection[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """What was given of the options, by field: of some fields first, then of all others; a flag taken back is False."""
    return given_of(OPTIONS, values, first)


def given_of(
    options: Collection[str], values: Mapping[str, Any], first: Collection[str]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The same of some options, by their fields."""
    given = {name: values[name] for name in options if values.get(name) is not None}
    given |= {name: False for name in options if values.get(f"{_TAKEN_BACK}{name}")}
    named = {name: value for name, value in given.items() if name in first}
    return named, {name: value for name, value in given.items() if name not in first}


def _parameter(name: str, annotation: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=annotation)


def _annotation(option: Option, hidden: bool) -> Any:
    shown = option.help.replace("[", r"\[")  # typer reads a help text as markup, in which [[events]] would be a tag
    more = option.more | {"metavar": option.metavar, "help": shown, "rich_help_panel": option.panel, "hidden": hidden}
    if option.complete is not None:
        more["autocompletion"] = completer(option.complete)
    return Annotated[option.kind | None, typer.Option(*option.names, **more)]


def _taking_back(option: Option) -> Any:
    """The flag that says that a flag is not given, whatever a file of settings says; help would only grow by it."""
    return Annotated[bool | None, typer.Option(f"--no-{option.names[0].removeprefix('--')}", hidden=True)]
