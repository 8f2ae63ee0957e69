"""Options that act at once, whatever else is given, and the words of the version: known without typer."""

from pvlvrt_compliance import __version__

HELP = ("-h", "--help")
VERSION = "--version"


def version() -> str:
    """What `VERSION` prints."""
    return f"pvlvrt-check {__version__}"
