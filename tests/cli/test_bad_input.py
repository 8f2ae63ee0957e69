"""Bad input: one clear line on stderr, status 2, and nothing written."""

import pytest

MAIN = ("--profile", "iec61400-21", "--sag", "90%")

BAD = {
    "sag above 100 %": ((*MAIN[:2], "--sag", "120%"), "--sag: '120%' is outside 0% to 100%"),
    "sag without percent sign": ((*MAIN[:2], "--sag", "90"), 'for 90 percent write "90%"'),
    "sag below zero": ((*MAIN[:2], "--sag", "-5%"), "'-5%' is outside"),
    "sag in letters": ((*MAIN[:2], "--sag", "abc"), "'abc' is not a fraction; write 90% or 0.9"),
    "sag that is not a number": ((*MAIN[:2], "--sag", "nan"), "'nan' is not a fraction"),
    "empty sag": ((*MAIN[:2], "--sag", ""), "--sag: '' is not a fraction"),
    "sag without value": ((*MAIN[:2], "--sag"), "'--sag' requires an argument"),
    "unknown profile": (("--profile", "iec61400", *MAIN[2:]), 'did you mean "iec61400-21"?'),
    "known profiles": (("--profile", "xyz", *MAIN[2:]), "known: dk-rfg, "),
    "no profile": (MAIN[2:], "--profile is missing; known profiles: dk-rfg, "),
    "absent profile file": (("--profile", "absent.toml", *MAIN[2:]), "no profile file at 'absent.toml'"),
    "profile without tests": (("--profile", "spain-q-curve"), "has no tests of its own"),
    "negative duration": ((*MAIN, "--duration", "-1s"), "--duration: '-1s' must be longer than zero"),
    "no duration": ((*MAIN, "--duration", "0ms"), "'0ms' must be longer than zero"),
    "duration without unit": ((*MAIN, "--duration", "5"), "'5' is not a duration; write 500ms or 0.5s"),
    "empty duration": ((*MAIN, "--duration", ""), "'' is not a duration"),
    "endless duration": ((*MAIN, "--duration", "1e9s"), "--duration: must be less than or equal to 3600"),
    "unknown phases": ((*MAIN, "--phases", "ac"), "--phases ac: unknown; allowed are abc, a, b, c, ab, bc, ca"),
    "two-phase of one": (
        (*MAIN, "--two-phase", "--phases", "a"),
        "--two-phase: a pair of phases is needed, ab, bc, ca",
    ),
    "unknown pair": ((*MAIN, "--two-phase", "xy"), "--phases xy: unknown"),
    "unknown pair after =": ((*MAIN, "--two-phase=xy"), "--phases xy: unknown"),
    "contradicting pairs": ((*MAIN, "--two-phase", "ab", "--phases", "bc"), "--phases: given twice"),
    "frequency": ((*MAIN, "--frequency", "40"), "--frequency: must be greater than or equal to 45, not 40.0"),
    "frequency in letters": ((*MAIN, "--frequency", "fast"), "Invalid value for '--frequency'"),
    "grid without strength": ((*MAIN, "--scr", "0"), "scr: must be greater than 0.5"),
    "strength that is not a number": ((*MAIN, "--scr", "nan"), "scr: nan is not a number that can be used"),
    "X/R": ((*MAIN, "--xr", "-1"), "xr: must be greater than 0"),
    "irradiance": ((*MAIN, "--irradiance", "5000"), "--irradiance: must be less than or equal to 1500"),
    "temperature": ((*MAIN, "--temperature", "500"), "--temperature: must be less than or equal to 90"),
    "point on wave": ((*MAIN, "--point-on-wave", "1000"), "--point-on-wave: must be less than or equal to 360"),
    "misspelt parameter": (
        (*MAIN, "--set", "controller.pr_integral_gian=0.2"),
        'unknown parameter; did you mean "controller.pr_integral_gain"',
    ),
    "parameter without group": (
        (*MAIN, "--set", "pr_integral_gain=0.2"),
        'unknown parameter; did you mean "controller.pr_integral_gain"',
    ),
    "parameter without value": ((*MAIN, "--set", "controller.sogi_gain"), "write --set group.name=value"),
    "parameter out of range": ((*MAIN, "--set", "plant.filter_inductance_h=0"), "--set plant.filter_inductance_h: "),
    "unknown fidelity": ((*MAIN, "--fidelity", "exact"), "--fidelity: Input should be 'averaged' or 'switched'"),
    "fidelity twice": (
        (*MAIN, "--fidelity", "switched", "--set", "simulation.fidelity=averaged"),
        "--fidelity: given twice",
    ),
    "unknown option": ((*MAIN, "--bogus"), "No such option: --bogus"),
    "unknown command": ((*MAIN, "extra"), "No such command 'extra'"),
    "sag options without sag": ((*MAIN[:2], "--phases", "a"), "need --sag"),
    "sag and test": ((*MAIN, "--test", "VD1*"), "it does not go with --sag"),
    "pattern that matches nothing": ((*MAIN[:2], "--test", "VD9*"), "--test VD9*: no test of this name"),
    "misspelt test": ((*MAIN[:2], "--test", "VD3-ful-1"), 'did you mean "VD3-full-1"'),
}


@pytest.mark.parametrize(("arguments", "says"), BAD.values(), ids=BAD.keys())
def test_one_line_status_2_and_nothing_written(command, tmp_path, arguments, says):
    """The line names the option and what is allowed; the output folder is not made."""
    folder = tmp_path / "deep" / "out"
    ended = command("--output", folder, *arguments)
    assert (ended.status, ended.out) == (2, "")
    assert says in ended.err
    assert ended.err.count("\n") == 1
    assert ended.err.startswith("pvlvrt-check: ")
    assert list(tmp_path.iterdir()) == []


def test_status_of_the_program(program, tmp_path):
    """A program that starts this one sees the same status and the same line."""
    ended = program("--profile", "iec61400-21", "--sag", "120%", cwd=tmp_path)
    assert ended == (2, "", "pvlvrt-check: --sag: '120%' is outside 0% to 100%\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("folder", ["file", "file/below/it", ""])
def test_output_that_cannot_be_written(command, tmp_path, monkeypatch, folder):
    """A file in the way, or no name at all, is reported before anything is simulated."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("mine")
    ended = command(*MAIN, "--output", folder)
    assert (ended.status, ended.out, ended.err.count("\n")) == (2, "", 1)
    assert "--output" in ended.err
    assert [p.name for p in tmp_path.iterdir()] == ["file"]
    assert (tmp_path / "file").read_text() == "mine"


def test_date_that_is_none(command, tmp_path):
    """A SOURCE_DATE_EPOCH that is not a number of seconds is refused."""
    ended = command(*MAIN, "--output", tmp_path / "out", SOURCE_DATE_EPOCH="yesterday")
    assert (ended.status, ended.err.count("\n")) == (2, 1)
    assert "SOURCE_DATE_EPOCH: 'yesterday' is not a number of seconds" in ended.err
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def own_profile(tmp_path):
    """Write a profile that includes the shipped one: ``own_profile(text) -> path``."""

    def write(text):
        path = tmp_path / "my-code.toml"
        head = 'schema_version = 1\nid = "my-code"\ntitle = "Mine"\ninclude = ["iec61400-21"]\n'
        path.write_text(head + text, "utf-8")
        return path

    return write


def test_broken_toml(command, own_profile, tmp_path):
    """The file is named, with line and column."""
    path = own_profile("[requirements\n")
    ended = command("--profile", path, "--sag", "90%", "--output", tmp_path / "out")
    assert ended.status == 2
    assert f"{path}: 1 problem\n  {path}:5: not TOML: " in ended.err
    assert "line 5" in ended.err
    assert not (tmp_path / "out").exists()


def test_unknown_key(command, own_profile, tmp_path):
    """File, key and the near miss; all problems at once."""
    path = own_profile('[requirements.current_limit]\nclaus = "7"\n[requirements.dc_ripple]\nlimit = 3\n')
    ended = command("--profile", path, "--sag", "90%", "--output", tmp_path / "out")
    assert ended.status == 2
    head, *problems = ended.err.splitlines()
    assert head == f"pvlvrt-check: {path}: 2 problems"
    assert any("requirements.current_limit.claus: unknown key" in line and '"clause"' in line for line in problems)
    assert any("requirements.dc_ripple.limit: unknown key" in line for line in problems)
    assert not (tmp_path / "out").exists()
