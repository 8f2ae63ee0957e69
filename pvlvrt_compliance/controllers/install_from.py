"""Where a project takes this package from, on whatever machine checks it."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

from pvlvrt_compliance import __version__
from pvlvrt_compliance.errors import UsageError, did_you_mean

PACKAGE = "pvlvrt-compliance"
WHEELS = "wheels"
"""Folder of a project that holds the wheel it is checked with."""

_SCHEMES = ("https", "git+https", "git+ssh")
_ALLOWED = (
    f"{PACKAGE}==VERSION, a wheel (FILE.whl), an address (https://.../FILE.whl) or a repository (git+https://...@TAG)"
)
_REQUIREMENT = re.compile(
    r"(?P<name>[A-Za-z0-9][A-Za-z0-9._-]*)(?:\[(?P<extras>[A-Za-z0-9,._-]*)\])?"
    r"(?P<versions>(?:(?:===?|[<>!~]=|[<>])[A-Za-z0-9.*+!_-]+)(?:,(?:===?|[<>!~]=|[<>])[A-Za-z0-9.*+!_-]+)*)?"
)
_ONE_VERSION = re.compile(r"={2,3}[^*,]+")
_SHORT = re.compile(r"(?P<user>[\w.-]+)@(?P<host>[\w.-]+):(?P<path>[^/].*)")  # git's short form of an address
_VARIABLE = re.compile(r"\$\{[A-Z0-9_]+\}")  # pip puts in its value


class Source(NamedTuple):
    """What a project installs."""

    requirement: str  # a line of requirements.txt
    says: str  # in words
    file: str  # in the project, when it is one
    wheel: bytes | None  # its content; none: it is not there yet, or no file
    pin: str = ""  # what would keep to one version, where the requirement does not


def source_of(spec: str | None, extras: Sequence[str] = ()) -> Source:
    """Where the package comes from, as the user has said.

    Parameters
    ----------
    spec : str, optional
        A requirement (``pvlvrt-compliance==0.2.0``), a wheel's file, an address of a wheel (https), or of a repository
        (``git+https://...@TAG``); without it a wheel of this version that is to be put into the project.
    extras : sequence of str
        Further features that the project needs.

    Raises
    ------
    UsageError
        When it is none of these, or would be there on this machine only.
    """
    if spec is None:
        return _wheel(f"{PACKAGE.replace('-', '_')}-{__version__}-py3-none-any.whl", None, extras)
    if spec.lower().endswith(".whl") and "://" not in spec:
        return _wheel(*_content(spec), extras)
    if not spec or not spec.isprintable() or re.search(r"[\s#;'\"`\\]", spec):
        raise _refused(spec, f"is empty, or has a blank, a quote, # or ;. Allowed are {_ALLOWED}")
    if "://" in spec:
        return _address(spec, extras)
    if short := _SHORT.fullmatch(spec):
        raise _refused(spec, f'did you mean "git+ssh://{short["user"]}@{short["host"]}/{short["path"]}"?')
    if Path(spec).exists():
        build = f"python -m pip wheel --no-deps --wheel-dir dist {spec}"
        raise _refused(spec, f"is on this machine only; build a wheel of it and name that ({build})")
    return _from_an_index(spec, extras)


def _refused(spec: str, why: str) -> UsageError:
    return UsageError(f"--install-from {spec}: {why}")


def _with(extras: Sequence[str]) -> str:
    return f"[{','.join(sorted(set(extras)))}]" if extras else ""


def _wheel(name: str, content: bytes | None, extras: Sequence[str]) -> Source:
    file = f"{WHEELS}/{name}"
    says = f"The tool comes from `{file}`, which is committed with the project."
    if content is None:
        says = (
            f"The tool comes from `{file}`, which is not there yet: in a checkout of the tool"
            f" `python -m pip wheel --no-deps --wheel-dir PROJECT/{WHEELS} .` makes it. Commit it with the project."
        )
    return Source(f"./{file}{_with(extras)}", says, file, content)


def _content(spec: str) -> tuple[str, bytes]:
    """Name and content of a wheel of this package."""
    import zipfile

    file, package = Path(spec), PACKAGE.replace("-", "_")
    if not re.fullmatch(rf"{package}-[A-Za-z0-9_.+!-]+\.whl", file.name):
        raise _refused(spec, f"is no wheel of this package, which is {package}-VERSION-py3-none-any.whl")
    try:
        with zipfile.ZipFile(file) as wheel:
            wheel.getinfo(f"{package}/__init__.py")
        return file.name, file.read_bytes()
    except OSError as error:
        raise _refused(spec, f"cannot be read ({error.strerror})") from None
    except (zipfile.BadZipFile, KeyError):
        raise _refused(spec, "is no wheel of this package, or a damaged one") from None


def _address(spec: str, extras: Sequence[str]) -> Source:
    try:
        parts = urlsplit(spec)
        secret, host = _VARIABLE.sub("", parts.password or ""), parts.hostname
    except ValueError as error:
        raise _refused(spec, f"is no address ({error})") from None
    if parts.scheme not in _SCHEMES:
        where = " is on this machine only;" if parts.scheme.endswith("file") else ""
        raise _refused(spec, f"{where} addresses begin with {', '.join(f'{x}://' for x in _SCHEMES)}".strip())
    if not host or len(parts.path) < 2:
        raise _refused(spec, "names no host, or nothing on it")
    if secret:
        raise _refused(
            parts._replace(netloc=host).geturl(), "has a password, which would be committed; write ${NAME} for it"
        )
    is_pinned = not parts.scheme.startswith("git+") or parts.path.partition("@")[2] != ""
    pin = "" if is_pinned else f"{spec.removesuffix('@')}@TAG"
    says = f"The tool comes from the address in `requirements.txt`.{_on_pinning(pin)}"
    return Source(f"{PACKAGE}{_with(extras)} @ {spec}", says, "", None, pin)


def _from_an_index(spec: str, extras: Sequence[str]) -> Source:
    found = _REQUIREMENT.fullmatch(spec)
    name = re.sub(r"[-_.]+", "-", found["name"]).lower() if found else ""
    if found is None or name != PACKAGE:
        raise _refused(spec, f"allowed are {_ALLOWED}{did_you_mean(name or spec, [PACKAGE])}")
    wanted = [*extras, *filter(None, (found["extras"] or "").split(","))]
    versions = found["versions"] or ""
    pin = "" if _ONE_VERSION.fullmatch(versions) else f"{PACKAGE}=={__version__}"
    where = "the package index that pip is set up for (`PIP_INDEX_URL` names another)"
    return Source(
        f"{PACKAGE}{_with(wanted)}{versions}", f"The tool comes from {where}.{_on_pinning(pin)}", "", None, pin
    )


def _on_pinning(pin: str) -> str:
    return f" That names no single version: `{pin}` does." if pin else ""
