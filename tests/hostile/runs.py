"""Files of a run that is whole: its results, its reports, and the same run in two parts; made once and kept."""

import contextlib
import io
import os
import tempfile
from functools import cache
from pathlib import Path
from unittest import mock

from tests.hostile import seeds
from tests.hostile.damage import File

_SHORT = ("--set", "simulation.settling_s=0.2", "--jobs", "1", "--waveforms", "none", "--quiet")


@cache
def files() -> dict[str, File]:
    """``results.json`` and the folders ``part1`` and ``part2``, with the same bytes each time.

    Raises
    ------
    AssertionError
        When a run that is meant well does not end well.
    """
    from pvlvrt_compliance.cli.main import run

    found = {}
    with (
        tempfile.TemporaryDirectory() as place,
        mock.patch.dict(os.environ, {"SOURCE_DATE_EPOCH": "1700000000"}),
        contextlib.chdir(place),
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(said := io.StringIO()),
    ):
        Path("ours.toml").write_bytes(seeds.made()["ours.toml"].content)
        for folder, more in (("whole", ()), ("part1", ("--shard", "1/2")), ("part2", ("--shard", "2/2"))):
            status = run(["--profile", "ours.toml", *_SHORT, "--isolated", "--output", folder, *more])
            assert status in (0, 1, 3), said.getvalue()
        # What a controller's process compiles is kept from then on, and takes no case's time.
        Path("ours.py").write_bytes(seeds.made()["ours.py"].content)
        assert run(["controllers", "inspect", "ours.py:Controller"]) == 0, said.getvalue()
        for part in ("part1", "part2"):
            found |= {f"{part}/{file.name}": File(file.read_bytes()) for file in Path(part).iterdir() if file.is_file()}
        found["results.json"] = File(Path("whole", "results.json").read_bytes())
    return found
