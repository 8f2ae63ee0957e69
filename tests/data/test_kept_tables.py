"""Tables that are kept are those that were read."""

import datetime
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.data import kept_tables, reader
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.scenario.files import load_events

EVENTS = '[[events]]\nkind = "phase_jump"\nt_s = 0\nangle_deg = 10\n'
COMMENT = "#" * 3000 + "\n"

ZONES = st.none() | st.integers(-1439, 1439).map(lambda m: datetime.timezone(datetime.timedelta(minutes=m)))
TIMES = (st.times() | st.datetimes(timezones=ZONES)).map(lambda t: t.replace(fold=0))  # which no text has
VALUES = st.recursive(
    st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.dates() | TIMES,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=8,
)


@pytest.fixture
def kept(monkeypatch, tmp_path):
    """A folder of its own for what is kept."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kept"))
    return tmp_path / "kept"


@given(st.dictionaries(st.text(max_size=4), VALUES, max_size=4))
def test_any_table_comes_back(table):
    """Values of all kinds that TOML has are the same, and of the same kind."""
    assert repr(kept_tables._unpacked(kept_tables._packed(table))) == repr(table)


@pytest.mark.usefixtures("kept")
def test_a_file_is_read_once(monkeypatch, tmp_path):
    """What was read in an earlier process is what the file has, with its dates."""
    file = tmp_path / "mine.toml"
    profile = known_profiles()["es-nts-631-lt110kv"].path.read_text("utf-8")
    file.write_text(f"read_on = 2024-02-29\n{profile}", "utf-8")
    first = reader.Source(file, reader.Kind("a profile", "profiles", PvlvrtError)).table
    monkeypatch.setattr(reader, "parse", None)
    again = reader.Source(file, reader.Kind("a profile", "profiles", PvlvrtError)).table
    assert again == first == tomllib.loads(file.read_text("utf-8"))
    assert again["read_on"] == datetime.date(2024, 2, 29)


def test_an_edit_is_read(kept, tmp_path):
    """Another text is another table."""
    file = tmp_path / "events.toml"
    for angle in (10, 20):
        file.write_text(COMMENT + EVENTS.replace("10", str(angle)))
        assert [event.angle_deg for event in load_events(str(file))] == [angle]
    assert len([*kept.iterdir()]) == 2


def test_what_is_wrong_is_told_again(kept, tmp_path):
    """A file with a mistake is never kept, so that each run tells it."""
    file = tmp_path / "events.toml"
    file.write_text(COMMENT + EVENTS.replace("10", '"\\u0000"'))
    for _ in range(2):
        with pytest.raises(PvlvrtError, match="control characters"):
            load_events(str(file))
    assert not kept.exists()


def test_a_short_file_is_read_each_time(kept, tmp_path):
    """It takes no longer than to look for what is kept."""
    file = tmp_path / "events.toml"
    file.write_text(EVENTS)
    load_events(str(file))
    assert not kept.exists()
