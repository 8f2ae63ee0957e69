"""What there is to say of the folder of compiled code: warnings, which change no verdict."""

import warnings
from pathlib import Path

from pvlvrt_compliance.errors import CompiledCodeWarning, KeptFileWarning
from pvlvrt_compliance.texts import each_line, printable


def discard(file: Path, why: object) -> None:
    """Throw a damaged file away and say so."""
    from pvlvrt_compliance.compiled.checked_file import throw_away  # every command loads this module

    throw_away(file)
    _say_once("damaged", f"{file}: damaged ({why}): thrown away and made anew")


def say_not_kept(why: object) -> None:
    """Say that every run compiles anew."""
    _say_once("not kept", f"compiled code is not kept, so the next run compiles it anew: {why}")


_OURS = "of_pvlvrt_check"  # mark of what formats warnings here

_said: set[str] = set()


def _say_once(kind: str, text: str) -> None:
    """Warn, once a process for each kind: where one file is bad others often are, and every kernel lacks the folder."""
    if kind not in _said:
        _said.add(kind)
        warnings.warn(text, CompiledCodeWarning, stacklevel=2)


def tell_in_lines() -> None:
    """Have these warnings, and no others, come as a line each of the command, whatever Python's options say of them."""
    warnings.filterwarnings("always", category=KeptFileWarning)
    others = warnings.formatwarning
    if hasattr(others, _OURS):  # many commands run in one process: each of them would go through all before it
        return

    def formatted(
        message: Warning | str, category: type[Warning], filename: str, lineno: int, line: str | None = None
    ) -> str:
        if issubclass(category, KeptFileWarning):
            return f"pvlvrt-check: {printable(str(message))}\n"
        return each_line(others(message, category, filename, lineno, line))

    setattr(formatted, _OURS, True)
    warnings.formatwarning = formatted
