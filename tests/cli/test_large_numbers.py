"""Numbers of thousands of digits, through every door that text comes in by: one line, and nothing is run."""

import re

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.units import ANGLE, FREQUENCY, parse_duration, parse_fraction, parse_quantity

DIGITS = "9" * 5000  # more than Python makes a whole number of
MAIN = ("--profile", "iec61400-21")
SAG = (*MAIN, "--sag", "50%")
CONTROLLER = ("--controller", "examples/program-python/controller.py:X")

OPTIONS = {
    "sag": (*MAIN, "--sag", DIGITS),
    "duration": (*SAG, "--duration", DIGITS),
    "duration with a unit": (*SAG, "--duration", f"{DIGITS}ms"),
    "point on wave": (*SAG, "--point-on-wave", DIGITS),
    "irradiance": (*SAG, "--irradiance", f"{DIGITS}W/m2"),
    "frequency": (*MAIN, "--frequency", DIGITS),
    "temperature": (*MAIN, "--temperature", f"-{DIGITS}"),
    "scr": (*MAIN, "--scr", DIGITS),
    "xr": (*MAIN, "--xr", DIGITS),
    "transformer": (*MAIN, "--transformer", f"Dyn{DIGITS}"),
    "jobs": (*MAIN, "--jobs", DIGITS),
    "shard": (*MAIN, "--shard", f"1/{DIGITS}"),
    "reuse size": (*MAIN, "--reuse", "kept", "--reuse-size", f"{DIGITS}GB"),
    "baseline tolerance": (*MAIN, "--baseline", "known.txt", "--baseline-tolerance", DIGITS),
    "a parameter": (*MAIN, "--set", f"controller.pr_integral_gain={DIGITS}"),
    "a whole one": (*MAIN, "--set", f"simulation.control_ratio={DIGITS}"),
    "a list": (*MAIN, "--set", f"sensors.voltage_gain=[1,1,{DIGITS}]"),
    "a word": (*MAIN, "--set", f"controller.precision={DIGITS}"),
    "one of a controller's own": (*MAIN, *CONTROLLER, "--set", f"controller.x={DIGITS}"),
    "a name": (*MAIN, "--set", f"{DIGITS}=1"),
    "a port": (*SAG, "--controller", f"tcp://127.0.0.1:{DIGITS}"),
}

FILES = {
    "settings": ("pvlvrt.toml", f"jobs = {DIGITS}\n", ("--config", "pvlvrt.toml", *MAIN)),
    "settings, as a text": ("pvlvrt.toml", f'jobs = "{DIGITS}"\n', ("--config", "pvlvrt.toml", *MAIN)),
    "settings of a parameter": (
        "pvlvrt.toml",
        f'[set]\n"controller.sogi_gain" = "{DIGITS}"\n',
        ("--config", "pvlvrt.toml", *MAIN),
    ),
    "a profile": ("mine.toml", f"schema_version = {DIGITS}\n", ("profiles", "check", "mine.toml")),
    "events": (
        "events.toml",
        f"[[events]]\nkind = 'phase_jump'\nt_s = 0\nangle_deg = {DIGITS}\n",
        (*SAG, "--events", "events.toml"),
    ),
    "events, with a fraction": (
        "events.toml",
        f"[[events]]\nkind = 'phase_jump'\nt_s = 0\nangle_deg = {DIGITS}.0\n",
        (*SAG, "--events", "events.toml"),
    ),
    "results": ("results.json", f'{{"schema_version": {DIGITS}}}', ("compare", "results.json", "results.json")),
    "results, deep inside": (
        "results.json",
        f'{{"schema_version": 1, "status": "pass", "tests": [{{"id": "x", "scenario": {{"a": {DIGITS}}}}}]}}',
        ("compare", "results.json", "results.json"),
    ),
    "results of a part": ("results.json", f'{{"schema_version": {DIGITS}}}', ("merge", ".", ".")),
    "results of the last run": (
        "results.json",
        f'{{"schema_version": {DIGITS}}}',
        (*MAIN, "--last-failed", "--output", "."),
    ),
    "a baseline": ("known.txt", f"# pvlvrt-baseline {DIGITS}\n", (*MAIN, "--baseline", "known.txt")),
    "a margin of a baseline": (
        "known.txt",
        f"# pvlvrt-baseline 1\na.b c pass {DIGITS} pu\n",
        (*MAIN, "--baseline", "known.txt"),
    ),
}


def is_refused(ended, lines):
    """Whether a run has ended with status 2, so many lines, and nothing of Python in them."""
    return (
        (ended.status, ended.out) == (2, "")
        and len(ended.err.splitlines()) <= lines
        and not re.search("Traceback|set_int_max_str_digits|pydantic", ended.err)
    )


@pytest.mark.parametrize("door", OPTIONS)
def test_as_an_option(command, tmp_path, monkeypatch, door):
    """The line says which option it is; nothing is written."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "known.txt").write_text("# pvlvrt-baseline 1\n", "utf-8")
    ended = command(*OPTIONS[door], "--output", "out")
    assert is_refused(ended, 1), ended.err
    assert next(word for word in reversed(OPTIONS[door]) if word.startswith("--")) in ended.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("door", FILES)
def test_in_a_file(command, tmp_path, monkeypatch, door):
    """The line says which file it is; one more says how many problems it has."""
    name, text, arguments = FILES[door]
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text(text, "utf-8")
    ended = command(*arguments)
    assert is_refused(ended, 3), ended.err
    assert name in ended.err


def test_in_a_variable(command):
    """The line says which variable it is."""
    ended = command(*MAIN, PVLVRT_JOBS=DIGITS)
    assert is_refused(ended, 2), ended.err
    assert "PVLVRT_JOBS" in ended.err


LONG = "9" * 200_000


@pytest.mark.parametrize(
    "text", [LONG, f"{LONG}x", f"{LONG}.{LONG}q", f"1e{LONG}%%", f"{LONG},", f"-.{LONG}e", f"1{' ' * 200_000}q"]
)
def test_digits_are_gone_through_once(text):
    """With the square of their number it would be hours."""
    for read in (
        parse_duration,
        parse_fraction,
        lambda text, what: parse_quantity(text, what, FREQUENCY),
        lambda text, what: parse_quantity(text, what, ANGLE),
    ):
        with pytest.raises(UsageError, match=r"^--x: "):
            read(text, "--x")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("--jobs", "1024"), ""),
        (("--jobs", "1025"), "--jobs 1025: give how many tests are run at once, 1 to 1024, or auto"),
        (("--reuse", "kept", "--reuse-size", "1e6GB"), ""),
        (
            ("--reuse", "kept", "--reuse-size", "1.01e6GB"),
            "--reuse-size: 1.01e6GB must be above zero and at most 1e+06",
        ),
        (("--reuse", "kept", "--reuse-size", "1e300GB"), "--reuse-size: 1e300GB must be above zero and at most 1e+06"),
        (("--sag", "50%", "--duration", "0.001ms"), ""),
        (("--sag", "50%", "--duration", "0.0009ms"), "--duration: must be greater than or equal to 0.000001"),
        (("--sag", "50%", "--duration", "3600s"), ""),
        (("--sag", "50%", "--duration", "3600.1s"), "--duration: must be less than or equal to 3600"),
        (("--scr", "100000"), ""),
        (("--scr", "100001"), "--scr: must be less than or equal to 100000"),
        (("--xr", "0.01", "--scr", "3"), ""),
        (("--xr", "0.0099", "--scr", "3"), "--xr: must be greater than or equal to 0.01"),
        (("--xr", "1000", "--scr", "3"), ""),
        (("--xr", "1001", "--scr", "3"), "--xr: must be less than or equal to 1000"),
    ],
)
def test_the_ends_of_what_an_option_takes(command, tmp_path, monkeypatch, given, said):
    """Just inside and just outside."""
    monkeypatch.chdir(tmp_path)
    ended = command(*MAIN, *given, "--list")
    assert ended.status == (2 if said else 0), ended.err
    assert said in ended.err
