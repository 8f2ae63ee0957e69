"""Same input, same bytes."""

import pytest

pytestmark = pytest.mark.slow

MOMENT = "1700000000"


@pytest.fixture(scope="module")
def twice(program, tmp_path_factory):
    """Files by name of one command run in two processes, whose hashes of texts differ."""

    def files(seed):
        folder = tmp_path_factory.mktemp("run")
        arguments = ("--profile", "iec61400-21", "--test", "VD6-full-*", "--csv")
        ended = program(*arguments, cwd=folder, SOURCE_DATE_EPOCH=MOMENT, PYTHONHASHSEED=seed)
        assert ended.status == 0
        return ended, {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}

    return files("1"), files("2")


def test_two_runs_are_byte_identical(twice):
    """Reports, waveforms and terminal of two runs are the same bytes once SOURCE_DATE_EPOCH fixes the time."""
    (ended, first), (again, second) = twice
    assert ended == again
    assert len(first) == 3 + 2 * 3
    assert {name.as_posix() for name in first if first[name] != second.get(name)} == set()


def test_files_carry_the_fixed_time(twice):
    """The time in the report and in the COMTRADE file is the one of SOURCE_DATE_EPOCH, in UTC."""
    (_, files), _ = twice
    by_name = {name.name: content.decode() for name, content in files.items() if name.suffix in {".json", ".cfg"}}
    assert "2023-11-14T22:13:20+00:00" in by_name["results.json"]
    assert "14/11/2023,22:13:20.000000" in by_name["VD6-full-1.cfg"]
