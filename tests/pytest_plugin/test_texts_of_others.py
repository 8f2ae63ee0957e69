"""What pytest prints of texts of others: they are lines of text."""

import json

import pytest

import worst

pytest_plugins = ["pytester"]

BY_HAND = """
class Controller:
    sample_time_s = 1e-4
    def reset(self, nominal):
        raise RuntimeError(WORST)
    def step(self, y):
        return 0.0, 0.0, 0.0
"""


@pytest.mark.slow
def test_a_controller_that_sends_them(project, pytester):
    """Why a test has failed is told as far as it can be shown."""
    pytester.makefile(".py", mine=f"WORST = {worst.WORST!a}\n{BY_HAND}")
    ended = project('profile = "iec61400-21"\ntest = "VD3-full-1"\ncontroller = "mine.py:Controller"\n', "--color=no")
    said = str(ended.stdout)
    worst.seen(said)
    assert worst.MARK in said


@pytest.mark.parametrize("key", ["profile", "test", "set", "nonsense", "controller"])
def test_a_file_of_settings_that_sends_them(project, key):
    """A file that cannot be used is told likewise."""
    text = json.dumps(worst.IN_TOML, ensure_ascii=False)
    more = "" if key == "profile" else 'profile = "iec61400-21"\n'
    ended = project(f"{more}{key} = {text}\n", "--color=no")
    worst.seen(str(ended.stdout))
    worst.seen(str(ended.stderr))
