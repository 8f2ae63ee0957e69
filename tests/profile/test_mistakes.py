"""Deliberate mistakes in a profile: each is told with its file, line and key."""

import re
import subprocess
import sys
from typing import NamedTuple

import pytest

from pvlvrt_compliance.errors import ProfileError
from pvlvrt_compliance.profile import load_profile
from waiting import PATIENCE_S

HERE = "# <-"


class Mistake(NamedTuple):
    """What is written, and what must be said; the line is the one that ends with `HERE`, the first if there is none."""

    text: str
    key: str
    says: str
    head: str = 'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["iec61400-21"]\n'


ENVELOPE = "[requirements.ride_through.envelope]\n"
LIMIT = "[requirements.dc_ripple.limit_percent]\n"
BARE = Mistake.__new__.__defaults__[0].rsplit("include", 1)[0]
REGIONS = """
[requirements.ride_through.regions]
low_quantity = "lowest_phase"
high_quantity = "highest_phase"
confidence = "chosen"
source = "s"
rows = [
  {{ voltage_pu = [0, 0.9], mode = "mandatory", ride_s = {} }}, # <-
  {{ voltage_pu = [0.9, 1.1], mode = "continuous" }},
]
"""
ROW = """
[[tests]]{}
id = "T"
clause = "c"
sag = {{ depth = 0.5 }}
duration_s = 0.5
powers = ["full"]
confidence = "memory"
source = "s"
"""
CUSTOM = "[requirements.custom.mine]\nclause = 'c'\nsource = 's'\n[requirements.custom.mine.numbers.a_pu] # <-\n"
MISTAKES = {
    "text for a number": Mistake(LIMIT + "value = 'x' # <-", "requirements.dc_ripple.limit_percent.value", "a number"),
    "number for a table": Mistake("[requirements.dc_ripple]\n\nlimit_percent = 1 # <-", "limit_percent", "a table"),
    "table for a number": Mistake(LIMIT + "value = { a = 1 } # <-", "limit_percent.value", "a number"),
    "flag for a number": Mistake(LIMIT + "value = true # <-", "limit_percent.value", "a number, not True"),
    "date for a number": Mistake(LIMIT + "value = 1979-05-27 # <-", "limit_percent.value", "a number"),
    "NaN": Mistake(LIMIT + "value = nan # <-", "limit_percent.value", "a finite number"),
    "infinity": Mistake(
        ENVELOPE + "points = [\n[0, 0],\n[1, inf], # <-\n]", "envelope.points[1][1]", "a finite number"
    ),
    "decreasing times": Mistake(ENVELOPE + "points = [[0, 0], [0.2, 0], [0.1, 1]] # <-", "envelope.points", "decrease"),
    "first time not zero": Mistake(ENVELOPE + "points = [[1, 0]] # <-", "envelope.points", "at 0 s"),
    "no points": Mistake(ENVELOPE + "points = [] # <-", "envelope.points", "at least 1 elements, not 0"),
    "point of one": Mistake(ENVELOPE + "points = [[0, 0],\n[1]] # <-", "envelope.points[1][1]", "missing"),
    "point without a mark": Mistake(
        ENVELOPE + "points = [[0, 0],\n{ t_s = 1, u_pu = 0.8, source = 's' }] # <-",
        "envelope.points[1].confidence",
        "missing",
    ),
    "key of a point": Mistake(
        ENVELOPE + "points = [{ t_s = 0, u = 0.8, source = 's', confidence = 'code' }] # <-",
        "envelope.points[0].u",
        '"u_pu"',
    ),
    "point that is a number": Mistake(ENVELOPE + "points = [1] # <-", "envelope.points[0]", "must be a list"),
    "marked times decrease": Mistake(
        ENVELOPE + "points = [[0, 0], [2, 0], { t_s = 1, u_pu = 0.8, source = 's', confidence = 'code' }] # <-",
        "envelope.points",
        "2 s is followed by 1 s",
    ),
    "half a mark": Mistake(
        REGIONS.format("1, source = 's'"), "regions.rows[0].confidence", "missing; a row with source of its own"
    ),
    "least current of nothing": Mistake(
        REGIONS.format(1)
        .replace('"s"\n', '"s"\nleast_current_of = "apparent"\n')
        .replace(" # <-", "")
        .replace("regions]", "regions] # <-"),
        "requirements.ride_through.regions",
        "least_current_fraction and least_current_of go together",
    ),
    "settling of no least current": Mistake(
        REGIONS.format(1)
        .replace(" # <-", "")
        .replace('"s"\n', '"s"\nleast_current_settling_s = { value = 1, confidence = "chosen", source = "s" } # <-\n'),
        "regions.least_current_settling_s",
        "goes with least_current_fraction only",
    ),
    "least current of another kind": Mistake(
        REGIONS.format(1).replace('"s"\n', '"s"\nleast_current_of = "mean" # <-\n').replace("}, # <-", "},"),
        "regions.least_current_of",
        "'apparent' or 'largest_phase'",
    ),
    "least current without a region for it": Mistake(
        REGIONS.format(1)
        .replace("mandatory", "permissive")
        .replace(
            '"s"\n',
            '"s"\nleast_current_of = "apparent"\n'
            'least_current_fraction = { value = 0.8, confidence = "code", source = "s" } # <-\n',
        )
        .replace("}, # <-", "},"),
        "regions.least_current_fraction",
        "needs a mandatory region",
    ),
    "least current over 1": Mistake(
        REGIONS.format(1)
        .replace(
            '"s"\n',
            '"s"\nleast_current_of = "apparent"\n'
            'least_current_fraction = { value = 80, confidence = "code", source = "s" } # <-\n',
        )
        .replace("}, # <-", "},"),
        "regions.least_current_fraction",
        "at most 1, not 80",
    ),
    "level above 2 pu": Mistake(ENVELOPE + "points = [[0, 3]] # <-", "envelope.points", "between 0 and 2 pu, not 3"),
    "negative level": Mistake(ENVELOPE + "points = [[0, -0.1]] # <-", "envelope.points", "between 0 and 2 pu"),
    "unknown interpolation": Mistake(
        ENVELOPE + "interpolation = 'x' # <-", "envelope.interpolation", "'linear' or 'step'"
    ),
    "wrong quantity": Mistake(
        ENVELOPE + "voltage_quantity = 'highest_phase' # <-", "envelope.voltage_quantity", "wrong extreme"
    ),
    "voltages that do not rise": Mistake(
        "[requirements.reactive_support.curve]\npoints = [[1, 0], [0, 1]] # <-",
        "reactive_support.curve.points",
        "increase",
    ),
    "residual over 1": Mistake(
        ROW.format("").replace("0.5 }", "-0.2 } # <-"), "tests[0].sag.depth", "equal to 0, not -0.2"
    ),
    "depth over 1": Mistake(ROW.format("").replace("0.5 }", "1.5 } # <-"), "tests[0].sag.depth", "equal to 1, not 1.5"),
    "missing clause": Mistake(ROW.format(" # <-").replace('clause = "c"\n', ""), "tests[0].clause", "missing"),
    "missing source": Mistake(ROW.format(" # <-").replace('source = "s"\n', ""), "tests[0].source", "missing"),
    "missing confidence": Mistake(CUSTOM + "value = 1\nsource = 's'", "custom.mine.numbers.a_pu.confidence", "missing"),
    "empty source": Mistake(LIMIT + "source = '' # <-", "limit_percent.source", "must not be empty"),
    "unknown confidence": Mistake(LIMIT + "confidence = 'sure' # <-", "limit_percent.confidence", "'confirmed'"),
    "unknown key": Mistake(
        "[conditions]\nblocked_pu_below = 1 # <-", "conditions.blocked_pu_below", '"blocked_below_pu"'
    ),
    "unknown table": Mistake("[requirments] # <-", "requirments", 'did you mean "requirements"'),
    "unknown requirement": Mistake(
        "[requirements.dc_riple] # <-\nclause = 'c'", "requirements.dc_riple", 'did you mean "dc_ripple"'
    ),
    "another unit": Mistake(
        "[procedure]\nbefore_ms = 300 # <-", "procedure.before_ms", 'did you mean "before_s"? It is in seconds'
    ),
    "no unit": Mistake("[procedure]\nafter = 2 # <-", "procedure.after", 'did you mean "after_s"? It is in seconds'),
    "unit of a row": Mistake(ROW.format("") + "before_cycles = 3 # <-", "tests[0].before_cycles", '"before_s"?'),
    "tolerance below 0": Mistake(
        "[requirements.current_limit]\ntolerance_pu.value = -0.1 # <-",
        "current_limit.tolerance_pu",
        "0 or above, not -0.1",
    ),
    "fraction over 1": Mistake(
        "[requirements.ride_through]\nrecovery_fraction.value = 95 # <-", "recovery_fraction", "at most 1, not 95"
    ),
    "power level unknown": Mistake(
        ROW.format("").replace('["full"]', '["ful"] # <-'), "tests[0].powers", "it has: full, partial"
    ),
    "steps unknown": Mistake(
        ROW.format("")
        .replace("duration_s = 0.5", 'steps = { table = "H", order = "AB" } # <-')
        .replace("sag =", "grid.scr = 3 #"),
        "tests[0].steps.table",
        "'H' is not in procedure.steps",
    ),
    "sag and steps": Mistake(
        ROW.format("").replace("duration_s = 0.5", 'steps = { table = "H", order = "AB" } # <-'),
        "tests[0].steps",
        "a test has a sag or steps, not both",
    ),
    "duration below 0": Mistake(
        ROW.format("").replace("duration_s = 0.5", "duration_s = -1 # <-"),
        "tests[0].duration_s",
        'or "envelope", not -1',
    ),
    "endless duration": Mistake(
        ROW.format("").replace("duration_s = 0.5", "duration_s = 1e9 # <-"), "tests[0].duration_s", "equal to 3600"
    ),
    "check unknown": Mistake(
        ROW.format("") + 'checks = ["dc_riple"] # <-', "tests[0].checks", 'did you mean "dc_ripple"'
    ),
    "unknown event": Mistake(
        ROW.format("") + "[[tests.events]] # <-\nkind = 'bang'\nt_s = 1", "tests[0].events[0]", "'bang'"
    ),
    "key of an event": Mistake(
        ROW.format("") + "[[tests.events]]\nkind = 'phase_jump'\nt_s = 1\nangle_deg = 3\nangle = 4 # <-",
        "tests[0].events[0].angle",
        'did you mean "angle_deg"',
    ),
    "value of an event": Mistake(
        ROW.format("") + "[[tests.events]]\nkind = 'phase_jump'\nt_s = 1\nangle_deg = 300 # <-",
        "tests[0].events[0].angle_deg",
        "equal to 180, not 300",
    ),
    "time of a region": Mistake(REGIONS.format("'x'"), "regions.rows[0].ride_s", "a number, not 'x'"),
    "times of a region": Mistake(
        REGIONS.format("{ at_pu = 0, s = 1 }"), "regions.rows[0].ride_s.slope_s_per_pu", "missing"
    ),
    "id twice": Mistake(
        ROW.format("") + ROW.format("").replace('id = "T"', 'id = "T" # <-'), "tests[1].id", "'T-1' occurs twice"
    ),
    "id with a blank": Mistake(ROW.format("").replace('"T"', '"a b" # <-'), "tests[0].id", "pattern"),
    "one test as a table": Mistake("[tests] # <-\nid = 'T'", "tests", "a list of tables, [[tests]]"),
    "tests of a number": Mistake("tests = 3 # <-", "tests", "a list of tables, [[tests]], not 3"),
    "test of a number": Mistake("tests = [\n3, # <-\n]", "tests[0]", "a table, not 3"),
    "nothing but a head": Mistake("", "procedure", "missing", BARE),
    "schema version": Mistake("schema_version = 9 # <-", "schema_version", "9 is not known", BARE.partition("\n")[2]),
    "include of nothing": Mistake(
        "include = [\n'spain-q-curve',\n'nowhere', # <-\n]", "include[1]", "no profile", BARE
    ),
    "misspelt include": Mistake("include = ['iec61400'] # <-", "include[0]", '"iec61400-21"', BARE),
    "include of any file": Mistake(
        "include = ['/etc/passwd'] # <-", "include[0]", "'/etc/passwd' must be the name of a profile, or the path", BARE
    ),
    "include of itself": Mistake("include = ['mine'] # <-", "include[0]", "without end", BARE),
    "include of a text": Mistake("include = 'iec61400-21' # <-", "include", "must be a list", BARE),
    "drop of nothing": Mistake("drop_tests = ['U5*'] # <-", "drop_tests[0]", "drops no test"),
    "key twice": Mistake(
        LIMIT + "value = 1\nvalue = 2 # <-", "value", "not TOML: a key or table that is there already"
    ),
    "table twice": Mistake("[windows]\n[windows] # <-", "windows", "not TOML: a key or table that is there already"),
    "nested too deeply": Mistake(f"windows = {'[' * 40}{']' * 40} # <-", "windows", "nested too deeply"),
    "dotted too deeply": Mistake(
        f"[windows]\nx.{'a.' * 20}a = {{ {'b.' * 20}b = 1 }} # <-", "windows", "nested too deeply"
    ),
    "terminal codes": Mistake('[windows]\nx = "\\u001b[2J" # <-', "windows.x", "control characters"),
}


@pytest.fixture
def made(tmp_path):
    """Write a mistake: ``made(mistake, newline, mark) -> (path, line)``."""

    def make(mistake, newline="\n", mark=""):
        text = mistake.head + mistake.text + "\n"
        lines = [number for number, line in enumerate(text.splitlines(), 1) if line.endswith(HERE)]
        assert len(lines) <= 1
        path = tmp_path / "mine.toml"
        path.write_bytes((mark + text.replace("\n", newline)).encode())
        return path, (lines or [1])[0]

    return make


def test_there_are_enough():
    """At least forty kinds of mistake."""
    assert len(MISTAKES) >= 40


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_file_line_and_key_are_told(made, mistake):
    """Each mistake is one problem line with the file, the line, the key and what is allowed."""
    path, line = made(mistake)
    with pytest.raises(ProfileError) as caught:
        load_profile(str(path))
    told = [text.removeprefix(f"{path}:{line}: ").partition(": ") for text in caught.value.problems]
    assert any(key.endswith(mistake.key) and mistake.says in says for key, _, says in told), caught.value.problems


@pytest.mark.parametrize("name", ["NaN", "another unit", "unknown event", "key twice", "include of itself"])
def test_the_program_ends_with_2(made, name):
    """Through the command: status 2, nothing on stdout, and the same line on stderr."""
    mistake = MISTAKES[name]
    path, line = made(mistake)
    program = [sys.executable, "-m", "pvlvrt_compliance.cli.main", "profiles", "check", str(path)]
    done = subprocess.run(program, capture_output=True, text=True, check=False, timeout=PATIENCE_S)
    assert (done.returncode, done.stdout) == (2, "")
    assert re.search(rf"^  {re.escape(f'{path}:{line}: ')}.*{re.escape(mistake.says)}", done.stderr, re.MULTILINE)


@pytest.mark.parametrize(("newline", "mark"), [("\r\n", ""), ("\n", "\ufeff")], ids=["CRLF", "byte order mark"])
def test_lines_of_files_from_other_systems(made, newline, mark):
    """Line ends of Windows and the mark its editors begin a file with are read, and lines count the same."""
    path, line = made(MISTAKES["decreasing times"], newline, mark)
    with pytest.raises(ProfileError, match=rf"mine\.toml:{line}: .*times must not decrease"):
        load_profile(str(path))
