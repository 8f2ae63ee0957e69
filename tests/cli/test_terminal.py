"""What a person at a terminal sees and a file does not: colour, and a bar while it lasts."""

import os
import re

import pytest

from terminals import at_terminal

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no pseudo-terminals of this kind")

_COLOUR = re.compile(r"\x1b\[(?:\d+;)*3[0-9](?:;\d+)*m")


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """Two tests at a terminal."""
    return at_terminal("--test", "VD3-full-*", "--verbose", cwd=tmp_path_factory.mktemp("terminal"))


def test_progress_is_shown_and_taken_away(seen):
    """The bar names the test that runs and how many are done; the table follows on a clean line."""
    status, text = seen
    assert status == 0
    bar, _, table = text.partition("test / check")
    assert "VD3-full-2" in bar
    assert "1/2" in bar
    assert "1/2" not in table


def test_verdicts_are_coloured(seen):
    """A verdict stands out at a terminal."""
    assert _COLOUR.search(seen[1].partition("test / check")[2])


def test_no_word_is_cut(seen):
    """Notes are broken between words where the line ends."""
    plain = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", seen[1])
    lines = [line.rstrip("\r") for line in plain.partition("Not verified")[2].splitlines()]
    assert max(map(len, lines[1:])) <= 80


def test_no_color(tmp_path):
    """NO_COLOR is honoured at a terminal."""
    status, text = at_terminal("--test", "VD3-full-1", cwd=tmp_path, NO_COLOR="1")
    assert status == 0
    assert not _COLOUR.search(text)


def test_quiet_shows_no_bar(tmp_path):
    """--quiet is one line at a terminal, too."""
    status, text = at_terminal("--test", "VD3-full-1", "--quiet", cwd=tmp_path, NO_COLOR="1")
    assert (status, text.strip()) == (0, "PASS: 1 test; checks: 7 pass; 1 marginal; 26 tests not selected")
