"""Paths in a file of settings: they count from its folder, wherever the command is run."""

import os
import re
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers.bundled import BUNDLED
from pvlvrt_compliance.controllers.spelling import names_module
from pvlvrt_compliance.data.search_path import is_path
from pvlvrt_compliance.ordinary_file import is_there
from pvlvrt_compliance.settings.setting import Setting

_SCHEME = re.compile(r"[A-Za-z]{2,}(?=://)")
_COMMAND = re.compile(r"stdio:")
_WORDS = re.compile(r"\S+")
_LOGO = "logo="


def placed(setting: Setting, value: Any, folder: Path) -> Any:
    """A value of a file, with what in it is a path as it is from the working directory.

    Paths are: of an option whose help has ``FILE`` or ``FOLDER``, the value; of ``NAME|FILE`` what is no name of a
    profile; of a controller its file, and of a command (``stdio:``) each word that names a file in the folder; of the
    fields of a report the logo. An address (``tcp://``) is none, nor the word for the bundled controller.

    Parameters
    ----------
    setting : Setting
    value
        As its option gives it.
    folder : Path
        Of the file, from the working directory.
    """
    if not isinstance(value, str | list) or folder == Path():
        return value
    if isinstance(value, list):
        return [placed(setting, item, folder) for item in value]
    if setting.metavar in ("FILE", "FOLDER") or (setting.metavar == "NAME|FILE" and is_path(value)):
        return _from_here(value, folder)
    if setting.field == "controller":
        return _controller(value, folder)
    if setting.field == "report_fields" and value.startswith(_LOGO):
        return f"{_LOGO}{_from_here(value.removeprefix(_LOGO), folder)}"
    return value


def _controller(spec: str, folder: Path) -> str:
    if spec == BUNDLED:
        return spec
    if _COMMAND.match(spec):
        return _WORDS.sub(lambda word: _word(word[0], folder), spec.removeprefix("stdio:")).join(("stdio:", ""))
    if _SCHEME.match(spec) or names_module(spec):
        return spec
    return _from_here(spec, folder)  # the class of FILE.py:CLASS stays behind its file


def _word(word: str, folder: Path) -> str:
    return _from_here(word, folder) if is_there(folder / word) else word


def _from_here(path: str, folder: Path) -> str:
    return os.path.normpath(folder / path)
