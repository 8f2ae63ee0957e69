"""What the documentation shows can be used as it stands."""

import re
from pathlib import Path

import pytest

from consoles import Shell, steps
from pvlvrt_compliance.scenario.files import load_events

PAGE = Path(__file__).parents[2] / "docs" / "events.md"


def example():
    """The file on the page."""
    (found,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    return found


def test_the_example_of_events_is_valid(tmp_path):
    """The file on the page of events reads, and shows every kind of event."""
    file = tmp_path / "events.toml"
    file.write_text(example(), "utf-8")
    kinds = {event.kind for event in load_events(str(file))}
    assert len(kinds) == 9


@pytest.mark.slow
def test_the_example_of_events_runs(tmp_path):
    """As written, with the recording that the page makes; what the page plays back is judged as the sag that it is."""
    shell = Shell(tmp_path)
    said = [shell.do(step.command) for step in steps(PAGE.read_text("utf-8"))]
    assert [ended.status for ended in said] == [0, 0, 0], said
    (tmp_path / "events.toml").write_text(example(), "utf-8")
    ended = shell.do("pvlvrt-check --profile iec61400-21 --sag 0% --duration 4s --events events.toml --quiet")
    assert ended.status in (0, 1), ended.said
