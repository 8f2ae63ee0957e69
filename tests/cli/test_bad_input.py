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
    "sag without value": (
        (*MAIN[:2], "--sag"),
        "--sag: the value is missing; --sag DEPTH: Depth of the sag, 90% or 0.9",
    ),
    "sag that swallows an option": (
        (*MAIN[:2], "--sag", "--phases", "ca"),
        "--sag: the value is missing before --phases",
    ),
    "value missing before a value behind =": (
        ("--profile", "--sag=90%"),
        "--profile: the value is missing before --sag=90%",
    ),
    "sag with a comma": ((*MAIN[:2], "--sag", "90,5%"), "'90,5%' is not a fraction, for it has a comma: 90.5%; write"),
    "sag in per unit": ((*MAIN[:2], "--sag", "0.9pu"), "for its unit 'pu' is not %; write 90% or 0.9"),
    "sag in two words": ((*MAIN[:2], "--sag", "90", "%"), 'no such command: %; did you mean "--sag 90%"?'),
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
    "unknown phases": (
        (*MAIN, "--phases", "ac"),
        '--phases ac: unknown; allowed are abc, a, b, c, ab, bc, ca; did you mean "ca"?',
    ),
    "phases by other names": ((*MAIN, "--phases", "L3-L1"), 'did you mean "ca"?'),
    "phase in capitals": ((*MAIN, "--phases", "C"), 'did you mean "c"?'),
    "two-phase of one": (
        (*MAIN, "--two-phase", "--phases", "a"),
        "--two-phase: a pair of phases is needed, ab, bc, ca",
    ),
    "unknown pair": ((*MAIN, "--two-phase", "xy"), "--phases xy: unknown"),
    "unknown pair after =": ((*MAIN, "--two-phase=xy"), "--phases xy: unknown"),
    "contradicting pairs": ((*MAIN, "--two-phase", "ab", "--phases", "bc"), "--phases: given twice"),
    "frequency": ((*MAIN, "--frequency", "40"), "--frequency: must be greater than or equal to 45, not 40.0"),
    "frequency in letters": (
        (*MAIN, "--frequency", "fast"),
        "--frequency: 'fast' is not a frequency; write 50Hz or 50",
    ),
    "frequency in kHz": ((*MAIN, "--frequency", "50kHz"), "--frequency: must be less than or equal to 66, not 50000.0"),
    "frequency in two words": ((*MAIN, "--frequency", "50", "Hz"), 'did you mean "--frequency 50Hz"?'),
    "temperature in kelvin": (
        (*MAIN, "--temperature", "318K"),
        "for its unit 'K' is none of C, degC, °C; write 45C or 45",
    ),
    "angle in radians": (
        (*MAIN, "--point-on-wave", "1.5rad"),
        "--point-on-wave: '1.5rad' is not an angle, for its unit",
    ),
    "irradiance with a comma": (
        (*MAIN, "--irradiance", "1,000"),
        "for it has a comma: 1.000 or 1000; write 800W/m2 or 800",
    ),
    "duration in minutes": ((*MAIN, "--duration", "5min"), "for its unit 'min' is none of ms, s; write 500ms or 0.5s"),
    "ratio with a unit": ((*MAIN, "--scr", "10x"), "--scr: '10x' is not a ratio, for its unit 'x' does not belong"),
    "no vector group": (
        (*MAIN, "--transformer", "Dyn12"),
        "--transformer: 'Dyn12' is no vector group; it is D, Y or YN",
    ),
    "vector group in small letters": ((*MAIN, "--transformer", "dyn-11"), 'did you mean "Dyn11"?'),
    "grid without strength": ((*MAIN, "--scr", "0"), "scr: must be greater than 0.5"),
    "strength that is not a number": ((*MAIN, "--scr", "nan"), "--scr: 'nan' is not a ratio; write 10 or 2.5"),
    "X/R": ((*MAIN, "--xr", "-1"), "xr: must be greater than or equal to 0.01"),
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
    "unknown fidelity": ((*MAIN, "--fidelity", "exact"), "--fidelity: must be 'averaged' or 'switched'"),
    "fidelity twice": (
        (*MAIN, "--fidelity", "switched", "--set", "simulation.fidelity=averaged"),
        "--fidelity: given twice",
    ),
    "unknown option": ((*MAIN, "--bogus"), "no such option: --bogus"),
    "unknown command": ((*MAIN, "extra"), "no such command: extra; there are: "),
    "misspelt option": (("--profle", "iec61400-21"), 'no such option: --profle; did you mean "--profile"'),
    "misspelt group": (("profile", "list"), 'no such command: profile; did you mean "profiles list"?'),
    "misspelt command": (("profiles", "lst"), 'no such command: lst; did you mean "profiles list"?'),
    "group alone": (("profiles",), "profiles: a command is missing; there are: list, show, "),
    "profile without its option": (
        ("iec61400-21", "--sag", "90%"),
        'no such command: iec61400-21; did you mean "--profile iec61400-21 --sag 90%"?',
    ),
    "file without its option": (("mine.toml", "--list"), 'did you mean "--profile mine.toml --list"?'),
    "depth without its option": (("90%", "--list"), 'did you mean "--sag 90% --list"?'),
    "controller without its option": (("my.py:C", "--list"), 'did you mean "--controller my.py:C --list"?'),
    "profile for a group": (("profiles", "iec61400-21"), 'did you mean "profiles show iec61400-21"?'),
    "controller for a group": (("controllers", "my.py:C"), 'did you mean "controllers inspect my.py:C"?'),
    "value for a flag": (("--csv", "yes"), "no such command: yes; --csv takes no value"),
    "two values behind one option": (("--test", "VD1*", "VD2*"), """did you mean "--test 'VD1*' --test 'VD2*'"?"""),
    "two profiles behind one option": (
        ("--profile", "iec61400-21", "nerc-prc-029"),
        'did you mean "--profile iec61400-21 --profile nerc-prc-029"?',
    ),
    "option of another command": (("profiles", "show", "--csv"), "no such option: --csv"),
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


BEFORE = {
    "option before a command": (
        ("--output", "zz", "compare", "main", "branch"),
        '--output stands before "compare"; put it behind: pvlvrt-check compare ... --output\n',
    ),
    "options before a command of a group": (
        ("--isolated", "--csv", "--csv", "config", "show"),
        '--isolated, --csv stand before "config"; put them behind: pvlvrt-check config show ... --isolated --csv\n',
    ),
    "option that the command does not take": (
        ("--baseline=nonesuch", "baseline", "update", "--results", "main"),
        '--baseline stands before "baseline"; baseline update does not take --baseline\n',
    ),
    "short option before a command": (("-q", "profiles", "list"), "profiles list does not take -q\n"),
}


@pytest.mark.parametrize(("arguments", "says"), BEFORE.values(), ids=BEFORE.keys())
def test_an_option_before_a_command_is_refused(command, arguments, says):
    """The command would not see it; it is said where it belongs, or that the command has no such option."""
    ended = command(*arguments)
    assert (ended.status, ended.out) == (2, "")
    assert says in ended.err


def test_what_acts_at_once_stands_anywhere(command):
    """Version and help are shown whatever command follows."""
    assert command("--version", "config", "show").out.startswith("pvlvrt-check ")
    assert "Usage" in command("--help", "config").out
