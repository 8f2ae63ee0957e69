"""Templates of the folder `reports`, compiled once for all runs."""

import sys
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from jinja2 import BytecodeCache, Environment, FileSystemLoader, StrictUndefined
from jinja2.bccache import Bucket

from pvlvrt_compliance.cache import keep, look_up, named

_OF_ALL: dict[str, Any] = {"autoescape": True, "undefined": StrictUndefined, "trim_blocks": True}


def environment(folder: Path, maker: str, **more: Any) -> Environment:
    """Templates that are compiled when one is needed, unless an earlier process has done so.

    Parameters
    ----------
    folder : Path
        Where they lie.
    maker : str
        File of the module that asks: what it adds to the environment is a part of what they are compiled from.
    **more
        Of `jinja2.Environment`, beside what holds for all.
    """
    return Environment(loader=FileSystemLoader(folder), bytecode_cache=_Kept(maker, more), **(_OF_ALL | more))


class _Kept(BytecodeCache):
    """Compiled templates in the user's folder: as trusted as the simulator's machine code there, which runs, too."""

    def __init__(self, maker: str, more: Mapping[str, Any]) -> None:
        # jinja2's own key knows its template alone.
        versions = f"{version('jinja2')} {version('markupsafe')} {sys.version}"
        self._maker: list[str | bytes] = [f"{versions} {sorted(more.items())}"]
        self._maker += [Path(file).read_bytes() for file in (__file__, maker)]

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill a bucket with what is kept for its template."""
        found = look_up(self._name(bucket))
        if found is not None:
            bucket.bytecode_from_string(found)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep what a template has been compiled to."""
        keep(self._name(bucket), bucket.bytecode_to_string())

    def _name(self, bucket: Bucket) -> str:
        return named("template", bucket.key, bucket.checksum, *self._maker)
