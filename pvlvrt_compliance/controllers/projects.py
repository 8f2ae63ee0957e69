"""Projects that a controller of one's own begins with: the files of `templates`, by kind.

What lies in a kind's folder and in `templates/shared` is a project's; a name that ends with ``.j2`` is rendered, with
signs of its own (``[[ ]]``, ``[% %]``), as CI systems use those that are usual.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment

    from pvlvrt_compliance.controllers.install_from import Source

_TEMPLATES = Path(__file__).with_name("templates")
_SHARED = "shared"
_RENDERED = ".j2"
_PART = "_"  # begins the name of what others are made from
_PLACES = {  # of files that lie elsewhere in a project, or whose name begins with a dot
    "compliance.yml": ".github/workflows/compliance.yml",
    "gitlab-ci.yml": ".gitlab-ci.yml",
    "pre-commit-config.yaml": ".pre-commit-config.yaml",
    "gitignore": ".gitignore",
}
# A sag of its own: it names no test, so it is judged by whatever profile a project changes to.
_ONE_SAG = "pvlvrt-check --sag 50% --output .cache/gate"


@dataclass(frozen=True, kw_only=True)
class Kind:
    """What sets projects of one kind apart."""

    spec: str  # of its controller
    sources: tuple[str, ...]  # what its controller is made from
    build: str = ""  # command that makes it
    compiles: bool = False  # needs a C compiler
    product: str = ""  # file that is built
    gate: str = _ONE_SAG  # what is run before a commit
    gate_file: str = ".pre-commit-config.yaml"  # where the command of it stands
    extras: tuple[str, ...] = ()  # of this package
    tools: tuple[str, ...] = ()  # further packages
    others: tuple[str, ...] = ()  # files that it has from the project in Python


_KINDS = {
    "python": Kind(spec="controller.py:Controller", sources=("controller.py",)),
    "c": Kind(
        spec="./libcontroller.so",
        sources=("controller.c", "libcontroller.mapping.toml", "Makefile"),
        build="make libcontroller.so",
        compiles=True,
        product="libcontroller.so",
        gate="make gate",
        gate_file="Makefile",
    ),
    "fmu": Kind(
        spec="./MyController.fmu",
        sources=("controller.py", "slave.py", "MyController.mapping.toml", "Makefile"),
        build="make MyController.fmu",
        product="MyController.fmu",
        gate="make gate",
        gate_file="Makefile",
        extras=("fmi",),
        tools=("pythonfmu>=0.6.5",),
        others=("controller.py",),
    ),
}
KINDS = tuple(_KINDS)
"""Kinds of projects, as ``pvlvrt-check controllers new --kind`` has them."""


@dataclass(frozen=True)
class Project:
    """A project that is not written yet."""

    files: dict[str, bytes]  # by their paths in it (POSIX)
    missing: str  # file that its owner has yet to put there; empty: none
    pin: str  # what would keep it to one version of this package, where nothing does


def project(kind: str, install_from: str | None = None) -> Project:
    """Begin a project.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    install_from : str, optional
        Where it takes this package from: see `install_from.source_of`.

    Raises
    ------
    UsageError
        When ``install_from`` cannot be used.
    """
    from pvlvrt_compliance.controllers.install_from import source_of

    source = source_of(install_from, _KINDS[kind].extras)
    files = _files(kind, source)
    if source.wheel is not None:
        files[source.file] = source.wheel
    return Project(files, source.file if source.wheel is None else "", source.pin)


def project_files(kind: str) -> dict[str, bytes]:
    """Files of a project that is to be given its wheel; one in C has the header of its interface."""
    return project(kind).files


def _files(kind: str, source: "Source") -> dict[str, bytes]:
    made = _KINDS[kind]
    named = [f"{folder}/{file.name}" for folder in (_SHARED, kind) for file in sorted((_TEMPLATES / folder).iterdir())]
    named += [f"python/{name}" for name in made.others]
    environment = _environment()
    files = {}
    for template in named:
        name = template.rpartition("/")[2]
        if name.startswith(_PART):
            continue
        content = (_TEMPLATES / template).read_bytes()
        if name.endswith(_RENDERED):
            name = name.removesuffix(_RENDERED)
            content = environment.get_template(template).render(kind=made, source=source, one_sag=_ONE_SAG).encode()
        files[_PLACES.get(name, name)] = content
    if made.compiles:
        from pvlvrt_compliance.controllers.library import HEADER

        files[HEADER.name] = HEADER.read_bytes()
    return dict(sorted(files.items()))


def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        undefined=StrictUndefined,
        autoescape=False,  # none of them is HTML
        variable_start_string="[[",
        variable_end_string="]]",
        block_start_string="[%",
        block_end_string="%]",
        comment_start_string="[#",
        comment_end_string="#]",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["escaped"] = re.escape
    return environment
