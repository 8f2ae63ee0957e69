"""What the documentation shows can be used as it stands."""

import re
from pathlib import Path

from pvlvrt_compliance.scenario.files import load_events

PAGE = Path(__file__).parents[2] / "docs" / "events.md"


def test_the_example_of_events_is_valid(tmp_path):
    """The file on the page of events reads, and shows every kind of event."""
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    file = tmp_path / "events.toml"
    file.write_text(example, "utf-8")
    kinds = {event.kind for event in load_events(str(file))}
    assert len(kinds) == 9
