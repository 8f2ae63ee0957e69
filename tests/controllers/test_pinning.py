"""Whether what a project installs is one version: else a gate may change its mind by itself."""

import re

import pytest

from pvlvrt_compliance.cli.main import run
from pvlvrt_compliance.controllers.projects import project


@pytest.mark.parametrize(
    ("spec", "is_pinned"),
    [
        ("pvlvrt-compliance", False),
        ("pvlvrt-compliance>=0.2", False),
        ("pvlvrt-compliance~=0.2,!=0.2.1", False),
        ("pvlvrt-compliance==0.2.*", False),
        ("pvlvrt-compliance[pdf]==0.2.0", True),
        ("pvlvrt-compliance===0.2.0", True),
        ("git+https://host.example/a/b", False),
        ("git+ssh://git@host.example/a/b.git", False),
        ("git+https://host.example/a/b@", False),
        ("git+https://host.example/a/b@release/1", True),
        ("https://host.example/x.whl", True),
    ],
)
def test_a_gate_that_is_not_pinned_is_told(spec, is_pinned, tmp_path, capsys):
    """It is begun all the same; a line on stderr and the README say what would keep to one version."""
    assert run(["controllers", "new", "--install-from", spec, str(tmp_path / "mine")]) == 0
    said, readme = capsys.readouterr().err.splitlines(), (tmp_path / "mine" / "README.md").read_text("utf-8")
    assert ("names no single version" in readme) != is_pinned
    if is_pinned:
        assert said == []
        return
    (line,) = said
    assert line.startswith(f"--install-from {spec}: names no single version")
    pin = re.search(r"pin it, as (\S+) does$", line)[1]
    assert f"`{pin}`" in readme
    assert project("python", pin).pin == ""
