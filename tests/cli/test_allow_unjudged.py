"""--allow-unjudged: what it lets pass, and what it never does."""

import pytest

PROFILE = """
schema_version = 1
id = "my-code"
title = "Mine, with a requirement of a package that is not installed"
include = ["iec61400-21"]
[requirements.custom.nobody_knows]
clause = "9.9"
source = "mine"
"""
TRIP = ("--set", "protection.overcurrent_pu=1.1")
OVERFLOW = ("--set", "controller.sogi_gain=1000")
NOT_STARTED = ("--irradiance", "800", "--set", "controller.mppt_voltage_max_v=610")


@pytest.mark.parametrize(
    ("options", "plain", "allowed", "outcome"),
    [((), 3, 0, "skipped"), (TRIP, 3, 1, "skipped"), (OVERFLOW, 3, 3, "error"), (NOT_STARTED, 3, 3, "skipped")],
    ids=["passes", "a fail", "an error", "nothing judged"],
)
def test_exit_status_and_junit(command, reports, tmp_path, options, plain, allowed, outcome):
    """What is unjudged no longer makes 3; a fail still makes 1, an error 3, and without any pass the end is never 0."""
    profile = tmp_path / "my-code.toml"
    profile.write_text(PROFILE, "utf-8")
    for asked, status in (((), plain), (("--allow-unjudged",), allowed)):
        folder = tmp_path / f"out{len(asked)}"
        done = command("--profile", profile, "--sag", "90%", *options, *asked, "--output", folder)
        found = reports(folder)
        assert done.status == status, done.err
        assert found.json["allow_unjudged"] is bool(asked)
        case = found.junit.find(".//testcase[@name='nobody_knows']")
        expected = outcome if asked else "error"
        assert [child.tag for child in case] == [expected]
        assert case[0].get("message")
        red = int(found.junit.get("errors")) + int(found.junit.get("failures"))
        assert (red > 0) is (status != 0)


def test_the_help_has_an_example(command):
    """How to let what is unjudged pass stands in the help."""
    words = " ".join(command("--help").out.replace("│", " ").split())
    assert "--profile all --sag 50% --allow-unjudged" in words
