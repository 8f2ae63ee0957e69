"""What an option of the main command is."""

from typing import Any, NamedTuple

from pvlvrt_compliance.units import RATIO, parse_quantity


class Option(NamedTuple):
    """An option; where it is not given its value is None, whatever its type.

    Parameters
    ----------
    kind : type
        Of its value: `list[str]` makes it repeatable, `bool` a flag, which may be taken back by a ``--no-`` form.
    names : tuple of str
        As it is spelled, the one that messages use first.
    metavar : str
        What the help shows in place of the value.
    help : str
        A sentence.
    panel : str, optional
        Heading that it stands under in the help.
    more
        Whatever else `typer.Option` takes.
    complete : str, optional
        What a shell may offer as its value: a function of `cli.completion.values`, by name, so that the table loads
        nothing. Without, a shell offers files.
    """

    kind: Any
    names: tuple[str, ...]
    metavar: str
    help: str
    panel: str | None = None
    more: dict[str, Any] = {}  # noqa: RUF012 - never changed
    complete: str | None = None


def text(name: str, metavar: str, help: str, panel: str | None = None, complete: str | None = None) -> Option:
    """An option that takes a text."""
    return Option(str, (name,), metavar, help, panel, complete=complete)


def texts(name: str, metavar: str, help: str, panel: str | None = None, complete: str | None = None) -> Option:
    """An option that takes a text and may be given several times."""
    return Option(list[str], (name,), metavar, help, panel, complete=complete)


def number(name: str, metavar: str, help: str, panel: str | None = None) -> Option:
    """An option that takes a number without a unit; one with a unit is a text, which its field understands."""

    def parsed(text: str) -> Any:
        """A number; an empty text may take one back that a file of settings gives, so it is one for now."""
        return parse_quantity(text, name, RATIO) if text else text

    return Option(float, (name,), metavar, help, panel, {"parser": parsed})


def flag(
    name: str,
    *others: str,
    help: str,
    panel: str | None = None,
    metavar: str = "",
    more: dict[str, Any] | None = None,
) -> Option:
    """An option without a value."""
    return Option(bool, (name, *others), metavar, help, panel, more=more or {})
