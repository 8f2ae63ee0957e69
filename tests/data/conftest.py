"""Each kind of file that people write: how it is loaded, one that is sound, and one with mistakes."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.scenario.files import load_events


class Kind(NamedTuple):
    """A kind of file; ``key`` and ``allowed`` are of the third line of ``wrong``."""

    load: Callable[[str], Any]
    many: str
    sound: str
    wrong: str  # its third and fourth lines have mistakes
    problems: tuple[str, ...]


KINDS = {
    "profile": Kind(
        load_profile,
        "profiles",
        'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["iec61400-21"]\n',
        'schema_version = 1\ninclude = ["iec61400-21"]\nidd = "mine"\nid = 3\ntitle = "t"\n',
        ('3: idd: unknown key; did you mean "id"?', "4: id: must be a text, not 3"),
    ),
    "events": Kind(
        load_events,
        "events files",
        '[[events]]\nkind = "phase_jump"\nt_s = 0\nangle_deg = 10\n',
        '[[events]]\nkind = "phase_jump"\nangel_deg = 10\nangle_deg = 200\nt_s = 0\n',
        (
            '3: events[0].angel_deg: unknown key; did you mean "angle_deg"?',
            "4: events[0].angle_deg: must be less than or equal to 180, not 200",
        ),
    ),
    "mapping": Kind(
        load_mapping,
        "mapping files",
        '[inputs]\nVa = {signal = "u_a_v", unit = "V"}\n[outputs]\nma = "m_a"\n',
        '[inputs.Va]\nsignal = "u_a_v"\nunits = "V"\nsign = 2\n',
        ('3: inputs.Va.units: unknown key; did you mean "unit"?', "4: inputs.Va.sign: must be 1 or -1, not 2"),
    ),
}


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest) -> Kind:
    """Each kind of file in turn."""
    return KINDS[request.param]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Where a test writes its file."""
    return tmp_path / "mine.toml"


@pytest.fixture
def problems(kind: Kind, file: Path) -> Callable[[bytes | str], list[str]]:
    """Write a file that must be refused: ``problems(content) -> lines``, each without the name of the file."""

    def told(content: bytes | str) -> list[str]:
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        with pytest.raises(PvlvrtError) as caught:
            kind.load(str(file))
        head, *lines = str(caught.value).splitlines()
        assert head.startswith(f"{file}: {len(lines)} problem")
        assert all(line.startswith(f"  {file}:") for line in lines)
        return [line.removeprefix(f"  {file}:") for line in lines]

    return told
