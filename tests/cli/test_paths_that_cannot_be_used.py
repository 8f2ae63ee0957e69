"""A path that the system refuses to look at, too long or behind a folder that cannot be entered, is told in words."""

import os

import pytest

from pvlvrt_compliance import UsageError, check, compare

LONG = "x" * 300
MAIN = ("--profile", "iec61400-21", "--sag", "90%", "--isolated")
NT = pytest.mark.skipif(os.name == "nt", reason="Windows says it in other words")


@NT
@pytest.mark.parametrize(
    "words",
    [
        *((*MAIN, option, LONG) for option in ("--output", "--reuse", "--baseline", "--config", "--events")),
        ("baseline", "update", "--isolated", "--profile", LONG),
        ("controllers", "new", LONG),
        ("controllers", "replay", LONG + ".so", "--inputs", LONG),
        ("merge", LONG),
        ("profiles", "new", LONG),
        ("profiles", "check", LONG),
    ],
    ids=lambda words: "-".join(word.strip("-") for word in words if LONG not in word)[-24:],
)
def test_a_name_that_is_too_long(command, words):
    """Status 2 and the reason, never the number that the system has for it."""
    ended = command(*words)
    assert ended.status == 2
    assert ended.err.startswith("pvlvrt-check: ")
    assert "Errno" not in ended.err
    assert "Traceback" not in ended.err


@NT
@pytest.mark.parametrize("option", ["output", "reuse", "baseline", "recordings"])
def test_from_python_it_is_a_usage_error(option):
    """So it is told by a call, with the name of the keyword; nothing is simulated."""
    with pytest.raises(UsageError, match=rf"^{option}:? {LONG}: "):
        check("iec61400-21", sag="90%", **{option: LONG})


def test_two_runs_of_names_that_are_too_long():
    """Neither is a folder of results, nor a controller."""
    with pytest.raises(UsageError):
        compare(LONG, LONG)
