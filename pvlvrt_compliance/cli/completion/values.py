"""What a shell may offer for the value of an option, by the names that the table of options uses."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin

import typer

from pvlvrt_compliance.cli.completion.asking import Candidates

_READS_SETTINGS = "isolated"
"""Every command that reads settings takes this, to do without."""

_CONTROLLERS = ("controller", "old", "new")
"""Parameters of commands that name a controller."""


def profiles(_context: typer.Context, incomplete: str) -> Candidates:
    """Names of profiles with their titles, and files."""
    from pvlvrt_compliance.data.search_path import known_profiles

    names = {name: known.path for name, known in known_profiles().items() if name.startswith(incomplete)}
    return [(name, _title(path)) for name, path in names.items()] + _files(incomplete, ".toml")


def profiles_or_all(context: typer.Context, incomplete: str) -> Candidates:
    """The same, and the word for all of them."""
    from pvlvrt_compliance.study.job import ALL

    return [*profiles(context, incomplete), (ALL, "every known profile")]


def tests(context: typer.Context, _incomplete: str) -> Candidates:
    """Tests of the profiles that the line or the settings have, and rows of theirs that stand for several."""
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.data.search_path import known_profiles
    from pvlvrt_compliance.profile.loading import load_profile
    from pvlvrt_compliance.study.job import ALL
    from pvlvrt_compliance.study.selection import Assignment

    named = _given(context).get("profiles") or ()
    wanted = dict.fromkeys(name for item in named for name in (known_profiles() if item == ALL else (item,)))
    loaded = [load_profile(name, INSTALLED_KINDS) for name in wanted]
    found = [Assignment(profile, test) for profile in loaded for test in profile.tests()]
    ids = {item.test.id: item.test.title for item in found}
    rows = {row: f"all runs of {row}" for item in found for row in item.names if row not in ids}
    return list((ids | rows).items())


def parameters(context: typer.Context, incomplete: str) -> Candidates:
    """Names of parameters with an equals sign behind, and behind that sign the words that are allowed.

    Those of a user's own controller are not known without running it; it is not run for this.
    """
    from pvlvrt_compliance.controllers.bundled import BUNDLED
    from pvlvrt_compliance.simulation.parameters import OF_THE_HOST, Parameters

    name, equals, _ = incomplete.partition("=")
    found: Candidates = []
    given = _given(context)
    is_own = any(given.get(one) not in (None, BUNDLED) for one in _CONTROLLERS)
    for group, of_group in Parameters.model_fields.items():
        fields: dict[str, Any] = of_group.annotation.model_fields  # type: ignore[union-attr]
        for key, field in fields.items():
            if is_own and group == "controller" and key not in OF_THE_HOST:
                continue
            parameter = f"{group}.{key}"
            if not equals:
                found.append((f"{parameter}=", f"{field.description or ''} (default {field.default})".strip()))
            elif parameter == name:
                found += [(f"{name}={word}", "") for word in _words_of(field.annotation)]
    return found


def formats(_context: typer.Context, _incomplete: str) -> Candidates:
    """Formats of reports."""
    from pvlvrt_compliance.report.formats import names

    return _plain(names())


def languages(_context: typer.Context, _incomplete: str) -> Candidates:
    """Languages of the reports."""
    from pvlvrt_compliance.report.language import languages as known

    return _plain(known())


def report_fields(_context: typer.Context, _incomplete: str) -> Candidates:
    """Fields of a title page, with an equals sign behind."""
    from pvlvrt_compliance.results.details import FIELDS

    return _plain(f"{name}=" for name in FIELDS)


def checks(_context: typer.Context, _incomplete: str) -> Candidates:
    """Kinds of requirements that can be judged."""
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS

    return _plain(INSTALLED_KINDS)


def phases(_context: typer.Context, _incomplete: str) -> Candidates:
    """Phases of a sag."""
    from pvlvrt_compliance.scenario.sag import PhaseNames

    return _plain(get_args(PhaseNames))


def sag_types(_context: typer.Context, _incomplete: str) -> Candidates:
    """Types of a sag."""
    from pvlvrt_compliance.scenario.sag import Type

    return _plain(get_args(Type))


def fidelities(_context: typer.Context, _incomplete: str) -> Candidates:
    """How closely the inverter is modelled."""
    from pvlvrt_compliance.simulation.parameters import Fidelity

    return _plain(get_args(Fidelity))


def waveforms(_context: typer.Context, _incomplete: str) -> Candidates:
    """Which waveforms are kept."""
    from pvlvrt_compliance.study.job import WAVEFORMS_KEPT

    return _plain(WAVEFORMS_KEPT)


def vector_groups(_context: typer.Context, _incomplete: str) -> Candidates:
    """Vector groups that are built: of unlike windings the odd hours, of like windings the even ones."""
    windings = [(high, low, (high == "D") != (low == "d")) for high in ("D", "Y", "YN") for low in ("d", "y", "yn")]
    return _plain(f"{high}{low}{hour}" for high, low, unlike in windings for hour in range(int(unlike), 12, 2))


def project_kinds(_context: typer.Context, _incomplete: str) -> Candidates:
    """Kinds of projects that a controller of one's own begins with."""
    from pvlvrt_compliance.controllers.projects import KINDS

    return _plain(KINDS)


def time_scales(_context: typer.Context, _incomplete: str) -> Candidates:
    """Scales of the time in a drawing."""
    from pvlvrt_compliance.report.drawing.model import Scale

    return _plain(get_args(Scale))


def _given(context: typer.Context) -> dict[str, Any]:
    """What the line has, over what environment and file of settings say where its command asks these.

    Nothing of settings that are broken or refused: the command tells that, not the tabulator key.
    """
    from pvlvrt_compliance.cli.settled import of_options
    from pvlvrt_compliance.errors import PvlvrtError

    typed = {name: value for name, value in context.params.items() if value not in (None, ())}
    takes = {parameter.name for parameter in context.command.params}
    # Behind an option whose value is still to come typer has not got as far as the arguments.
    arguments = [each.name for each in context.command.params if each.param_type_name == "argument"]
    typed |= dict(zip(filter(None, arguments), context.args, strict=False))
    if _READS_SETTINGS not in takes:
        return typed
    try:
        holds = of_options(typed).to_run_by().given
    except (PvlvrtError, OSError):
        return typed
    return typed | {name: value for name, value in holds.items() if name in takes}


def _plain(words: Iterable[str]) -> Candidates:
    return [(word, "") for word in words]


def _title(path: Path) -> str:
    """Title in a profile's file, which is not read any further."""
    from pvlvrt_compliance.data.syntax import parse
    from pvlvrt_compliance.data.text import read_text

    return str(parse(read_text(path, "a profile"), "profiles").get("title", ""))


def _files(incomplete: str, suffix: str) -> Candidates:
    """Files in the folder that a half-written path leads to, spelled as it begins."""
    folder, slash, _ = incomplete.rpartition("/")
    found = Path(f"{folder}/" if slash else ".").glob(f"*{suffix}")
    return [(f"{folder}{slash}{file.name}", "") for file in sorted(found)]


def _words_of(annotation: Any) -> Iterator[str]:
    """Words that a parameter of this type may have as its value."""
    if get_origin(annotation) is Literal:
        yield from map(str, get_args(annotation))
    elif get_origin(annotation) in (Union, UnionType):
        for part in get_args(annotation):
            yield from _words_of(part)
    elif annotation is NoneType:
        yield "null"
    elif annotation is bool:
        yield from ("true", "false")
