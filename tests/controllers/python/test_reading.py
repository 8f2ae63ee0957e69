"""A class as its file has it, read and not run: attributes and defaults that are plain values, and nothing else."""

import inspect

import pytest

from pvlvrt_compliance.controllers.python.reading import as_written

TEXT = """
raise SystemExit("it was run")


class Base(Unknown, metaclass=Other):
    sample_time_s: float = 1e-4
    switches = ("trip", "block")
    computed = 1 / 3
    gains = [1.0, -2.0]

    def reset(self, nominal): ...


@decorated
class Mine(Base):
    sample_time_s = 2e-4

    def __init__(self, first, gain=2.0, /, limit=1, *more, name="x", scale=2 * pi, on=True, **rest): ...

    def step(self, y): ...
"""


@pytest.fixture
def mine(tmp_path):
    """The class of a file that must not be run."""
    (tmp_path / "mine.py").write_text(TEXT, "utf-8")
    found = as_written(str(tmp_path / "mine.py"), "Mine")
    assert found.file == tmp_path / "mine.py"
    return found.made


def test_attributes(mine):
    """Of its own and of a class before it in the same file; what is computed is not known."""
    assert (mine.sample_time_s, mine.switches, mine.gains) == (2e-4, ("trip", "block"), [1.0, -2.0])
    assert not hasattr(mine, "computed")
    assert callable(mine.reset)
    assert callable(mine.step)


def test_defaults_of_the_constructor(mine):
    """Those that are plain values, by name."""
    found = {name: argument.default for name, argument in inspect.signature(mine).parameters.items()}
    assert found == {"gain": 2.0, "limit": 1, "name": "x", "on": True}


def test_what_is_not_there(tmp_path):
    """No file, no class of that name: nothing is known. A text that is no Python has a class that says nothing."""
    (tmp_path / "mine.py").write_text(TEXT, "utf-8")
    assert as_written(str(tmp_path / "mine.py"), "Other") is None
    assert as_written(str(tmp_path / "absent.py"), "Mine") is None
    assert as_written("no.such.package.anywhere", "Mine") is None
    (tmp_path / "mine.py").write_bytes(b"\x00\xff class Mine(:")
    assert vars(as_written(str(tmp_path / "mine.py"), "Mine").made).get("sample_time_s") is None
