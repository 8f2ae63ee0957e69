"""`pvlvrt-check profiles`: list, show, plot, check, schema, new."""

import json
import os
import re
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ET

import jsonschema
import pytest

from pvlvrt_compliance.data.marks import marks_in
from pvlvrt_compliance.profile import known_profiles, load_profile, loading
from pvlvrt_compliance.profile.beginning import placeholders
from pvlvrt_compliance.resources import resource_folder

COMMANDS = ("list", "show", "plot", "check", "schema", "new")
SHIPPED = [name for name, known in known_profiles().items() if known.origin == "shipped"]
HEAD = 'schema_version = 1\nid = "mine"\ntitle = "Mine"\ninclude = ["iec61400-21"]\n'


@pytest.fixture
def mine(tmp_path):
    """Write a profile: ``mine(text) -> path``."""

    def write(text="", head=HEAD):
        (tmp_path / "mine.toml").write_text(head + text, "utf-8")
        return tmp_path / "mine.toml"

    return write


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_an_example(command, name):
    """Each command's help shows how to call it."""
    ended = command("profiles", name, "--help")
    assert (ended.status, ended.err) == (0, "")
    assert f"Example: pvlvrt-check profiles {name}" in " ".join(ended.out.split())
    assert max(map(len, ended.out.splitlines())) <= 80


def test_a_command_is_needed(command):
    """Without one, a line says so."""
    assert command("profiles") == (
        2,
        "",
        f"pvlvrt-check: profiles: a command is missing; there are: {', '.join(COMMANDS)}\n",
    )


def test_list_has_every_profile_on_a_line(command, mine, tmp_path):
    """Name, title, number of tests, frequency, weakest mark and origin; those of the user with their folder."""
    mine()
    ended = command("profiles", "list", PVLVRT_PROFILES=str(tmp_path))
    assert (ended.status, ended.err) == (0, "")
    lines = {line.split()[0]: line for line in ended.out.splitlines()[2:]}
    assert set(lines) == {*SHIPPED, "mine"}
    assert re.search(r"IEC 61400-21 voltage drops, .* +27 +50 +\S+ +shipped", lines["iec61400-21"])
    assert re.search(rf"Mine +27 +50 +chosen +{re.escape(str(tmp_path))}", lines["mine"])


def test_list_names_a_profile_that_is_broken(command, mine, tmp_path):
    """One broken file hides no other; the status tells."""
    mine("[conditions]\nfoo = 1\n")
    ended = command("profiles", "list", PVLVRT_PROFILES=str(tmp_path))
    assert ended.status == 2
    assert "1 problem: profiles check mine" in ended.out
    assert all(name in ended.out for name in SHIPPED)


def test_list_of_a_folder_that_is_not_there(command, tmp_path):
    """The variable is named."""
    ended = command("profiles", "list", PVLVRT_PROFILES=str(tmp_path / "nowhere"))
    assert (ended.status, ended.out) == (2, "")
    assert "$PVLVRT_PROFILES: there is no folder" in ended.err


@pytest.mark.parametrize("name", SHIPPED)
def test_show_tells_every_mark_and_clause(command, name):
    """Nothing that a profile says is left out: each source, each clause, each test."""
    profile = load_profile(name)
    out = command("profiles", "show", name).out
    for _, item in marks_in(profile):
        assert f"[{item.confidence}] " in out
        assert item.source in out
    for kind, requirement in profile.requirements.by_kind():
        assert f"\n{kind} ({requirement.clause})\n" in out
    for row in profile.all_rows:
        assert re.search(rf"^  {re.escape(row.id)} .*{re.escape(row.clause)}$", out, re.MULTILINE)


def test_show_fits_a_terminal(command):
    """At a terminal lines are broken between words; in a file each stays whole."""
    shown = command("profiles", "show", "iec61400-21", FORCE_COLOR="1", COLUMNS="80").out
    assert max(map(len, shown.splitlines())) <= 80
    whole = command("profiles", "show", "iec61400-21", COLUMNS="80").out
    assert max(map(len, whole.splitlines())) > 200


def test_show_spells_numbers_with_units(command):
    """Units stand behind the numbers, points as pairs, flags as words."""
    out = command("profiles", "show", "iec61400-21").out
    assert "recovery time: 1 s (from clearing) [chosen]" in out
    assert "limit: 0.15 % (amplitude, of the mean DC voltage) [chosen]" in out
    assert "(0, 0), (0.15, 0), (1.5, 0.85)" in out
    assert "clip to capability: yes" in out
    assert "full: 1000 W/m2 [chosen]" in out
    assert "TESTS: 9 rows, 27 runs" in out


def test_show_tells_marks_of_rows_and_what_tests_demand(command):
    """A row's own mark stands behind it; a test that may trip is told from one that is ridden through."""
    out = command("profiles", "show", "dk-rfg").out
    assert "frequency 47.5 to 49 Hz, ride 1800 s [code] Energinet MTB, area values: 30 minutes down to 47.5 Hz\n" in out
    assert "frequency 49 to 51 Hz\n" in out
    assert re.search(r"^  3ph-0.20-60s .* full +may trip +code ", out, re.MULTILINE)
    assert re.search(r"^  3ph-0.20 .* full,partial +ride through +code ", out, re.MULTILINE)
    out = command("profiles", "show", "nerc-prc-029").out
    assert "least current of: largest phase" in out


def test_show_tells_the_mark_of_a_point(command, tmp_path):
    """A point with a mark of its own is told with it."""
    points = "points = [[0, 0], { t_s = 1.5, u_pu = 0.8, confidence = 'memory', source = 'a point' }]"
    file = tmp_path / "mine.toml"
    head = 'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["iec61400-21"]\n'
    file.write_text(f"{head}[requirements.ride_through.envelope]\n{points}\n", encoding="utf-8")
    assert "(0, 0), (1.5, 0.8) [memory] a point\n" in command("profiles", "show", str(file)).out


@pytest.mark.parametrize("name", SHIPPED)
def test_show_json_is_the_resolved_profile(command, name):
    """The resolved profile, read again as a profile, is the same."""
    content = json.loads(command("profiles", "show", name, "--json").out)
    assert type(load_profile(name)).model_validate_json(json.dumps(content)).digest == load_profile(name).digest


@pytest.mark.parametrize("ending", ["svg", "png", "html"])
def test_plot(command, tmp_path, monkeypatch, ending):
    """A figure in the format of the file's name, whose name is printed."""
    monkeypatch.chdir(tmp_path)
    ended = command("profiles", "plot", "iec61400-21", "--output", f"a.{ending}")
    assert ended == (0, f"a.{ending}\n", "")
    content = (tmp_path / f"a.{ending}").read_bytes()
    assert content.startswith({"svg": b"<svg", "png": b"\x89PNG", "html": b"<!doctype html>"}[ending])
    assert content[-50:].strip().endswith({"svg": b"</svg>", "png": b"IEND\xaeB`\x82", "html": b"</html>"}[ending])


def test_the_figure_shows_the_numbers_of_the_profile(command, tmp_path, monkeypatch):
    """The corner of the envelope at 1.5 s and 0.85 pu stands where the numbers along the axes put it."""
    monkeypatch.chdir(tmp_path)
    command("profiles", "plot", "iec61400-21")
    svg = ET.parse(tmp_path / "iec61400-21.svg").getroot()
    space = "{http://www.w3.org/2000/svg}"
    numbers = [element for element in svg.iter(f"{space}text") if re.fullmatch(r"[0-9.]+", element.text)]
    first = [element for element in numbers if float(element.get("y")) < 450]  # of the upper axes
    along = {e.text: float(e.get("x")) for e in first if e.get("text-anchor") == "middle"}
    up = {e.text: float(e.get("y")) - 4 for e in first if e.get("text-anchor") == "end"}
    envelope = next(svg.iter(f"{space}polyline")).get("points").split()
    x, y = (float(part) for part in envelope[2].split(","))
    assert x == pytest.approx(along["1.5"], abs=0.2)
    assert y == pytest.approx(up["0.8"] + (up["0.8"] - up["0.6"]) / 4, abs=0.2)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("iec61400-21", "--output", "a.pdf"), "must end in .svg, .png, .html"),
        (("iec61400-21", "--output", "nowhere/a.svg"), "cannot be written"),
        (("iec61400-21", "--scale", "cubic"), "--scale cubic: allowed are linear, log"),
        (("nope",), "unknown profile 'nope'"),
    ],
)
def test_plot_refuses(command, tmp_path, monkeypatch, arguments, says):
    """One line and status 2."""
    monkeypatch.chdir(tmp_path)
    ended = command("profiles", "plot", *arguments)
    assert (ended.status, ended.out, ended.err.count("\n")) == (2, "", 1)
    assert says in ended.err
    assert not list(tmp_path.iterdir())


def test_plot_of_nothing(command, mine):
    """A profile without curves says so."""
    demands = '[requirements.dc_ripple]\nclause = "c"\nsource = "s"\n'
    marked = 'limit_percent = {{ value = 1, confidence = "chosen", source = "s" }}\n'.format()
    numbers = "".join(
        f'{key} = {{ value = 0.1, confidence = "chosen", source = "s" }}\n'
        for key in ("starting_power_fraction", "no_load_tolerance_pu", "blocked_below_pu")
    )
    times = "".join(
        f'{key} = {{ value = 1, confidence = "chosen", source = "s" }}\n'
        for key in ("before_s", "after_s", "default_duration_s")
    )
    path = mine(f"{demands}{marked}[conditions]\n{numbers}[procedure]\n{times}", HEAD.rsplit("include", 1)[0])
    assert command("profiles", "check", path).status == 0
    ended = command("profiles", "plot", path, "--output", path.with_suffix(".svg"))
    assert (ended.status, ended.err) == (
        2,
        "pvlvrt-check: mine: the profile has no envelope, regions or curve to draw\n",
    )


def test_a_png_names_the_extra_that_it_needs(command, tmp_path, monkeypatch):
    """Without matplotlib, the message says what to install and what works without."""
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    ended = command("profiles", "plot", "iec61400-21", "--output", tmp_path / "a.png")
    assert ended.status == 2
    assert "pip install 'pvlvrt-compliance[plot]'; .svg and .html need nothing more" in ended.err


def test_check_says_what_is_not_verified(command):
    """A good profile is counted, its doubts listed."""
    ended = command("profiles", "check", "iec61400-21")
    assert (ended.status, ended.err) == (0, "")
    head, *doubts = ended.out.splitlines()
    assert head == f"ok: 27 tests, 7 requirements, {len(doubts)} not verified"
    assert tuple(line.strip() for line in doubts) == load_profile("iec61400-21").unverified()


def test_check_tells_all_problems(command, mine):
    """Each with file, line and key, on stderr; status 2."""
    path = mine("[conditions]\nfoo = 1\n[windows]\nduring_end_ms = 3\n")
    ended = command("profiles", "check", path)
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.splitlines()[0] == f"pvlvrt-check: {path}: 2 problems"
    assert f"  {path}:6: conditions.foo: unknown key; allowed: " in ended.err
    assert (
        f'  {path}:8: windows.during_end_ms: unknown key; did you mean "during_end_s"? It is in seconds\n' in ended.err
    )


@pytest.fixture(scope="module")
def schema(command):
    """The schema that is printed."""
    schema = json.loads(command("profiles", "schema").out)
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_files_follow_the_schema(schema, name):
    """An editor finds nothing wrong with a shipped file."""
    schema.validate(tomllib.loads(known_profiles()[name].path.read_text("utf-8")))


@pytest.mark.parametrize(
    "text",
    [
        "include = 3",
        "drop_tests = [1]",
        "[conditions]\nfoo = 1",
        "[requirements.ride_through.envelope]\ninterpolation = 'cubic'",
        "[requirements.dc_ripple]\nlimit_percent = 0.3",
        "[requirements.dc_ripple.limit_percent]\nconfidence = 'sure'",
        "[[tests]]\nsag.depth = 2",
        "[tests]",
    ],
)
def test_the_schema_finds_mistakes(schema, text):
    """Unknown keys, wrong types, words and ranges are seen by an editor."""
    table = tomllib.loads(HEAD.replace("include", "#") + text)
    assert list(schema.iter_errors(table))


def test_new_begins_a_profile_that_checks(command, tmp_path, monkeypatch, schema):
    """The file passes the check, has an envelope and tests, and follows the schema."""
    monkeypatch.chdir(tmp_path)
    assert command("profiles", "new", "plant-7") == (0, "plant-7.toml\n", "")
    assert command("profiles", "check", "plant-7.toml").status == 0
    profile = load_profile("plant-7.toml")
    assert profile.id == "plant-7"
    assert len(profile.tests()) == 5
    table = tomllib.loads((tmp_path / "plant-7.toml").read_text("utf-8"))
    schema.validate(table)
    assert "include" not in table  # of another country's demands
    assert all(len(line) <= 120 for line in (tmp_path / "plant-7.toml").read_text("utf-8").splitlines())


def test_check_warns_of_what_is_still_as_it_was_begun(command, tmp_path, monkeypatch):
    """Each is told with its line and key, of an included file, too, until it is replaced; it is no problem."""
    monkeypatch.chdir(tmp_path)
    command("profiles", "new", "plant-7")
    file = tmp_path / "plant-7.toml"
    lines = file.read_text("utf-8").splitlines()
    head, *told = command("profiles", "check", "plant-7.toml").out.splitlines()
    left = [line.strip() for line in told if ": placeholder" in line and line.startswith("  plant-7.toml:")]
    assert head.endswith(f", {len(left)} placeholders")
    assert (
        f"plant-7.toml:{1 + lines.index(next(x for x in lines if x.startswith('title')))}: title: placeholder" in left
    )
    limit = 1 + lines.index(next(x for x in lines if x.startswith("limit_pu")))
    assert f"plant-7.toml:{limit}: requirements.current_limit.limit_pu: placeholder (value, source)" in left
    (tmp_path / "over.toml").write_text('schema_version = 1\nid = "over"\ntitle = "Mine"\ninclude = ["plant-7.toml"]\n')
    of_both = command("profiles", "check", "over.toml")
    assert of_both.status == 0
    assert "title: placeholder" not in of_both.out
    assert f"plant-7.toml:{limit}: requirements.current_limit.limit_pu: placeholder (value, source)" in of_both.out
    file.write_text("\n".join(lines).replace("placeholder", "a"), "utf-8")
    assert "placeholder" not in command("profiles", "check", "plant-7.toml").out


@pytest.mark.parametrize("name", SHIPPED)
def test_no_shipped_profile_has_a_placeholder(name):
    """What ships is finished."""
    assert placeholders(name) == ()


def test_what_is_begun_can_be_run(command, tmp_path, monkeypatch):
    """As it is, the bundled control meets it in the shortest of its tests."""
    monkeypatch.chdir(tmp_path)
    command("profiles", "new", "mine")
    ended = command("--profile", "./mine.toml", "--test", "two-phase-50", "--quiet", "--waveforms", "none")
    assert (ended.status, ended.out) == (0, "PASS: 1 test; checks: 3 pass; 4 tests not selected\n")


def test_new_prints_without_a_name(command, tmp_path):
    """To be put where one likes."""
    ended = command("profiles", "new")
    (tmp_path / "a.toml").write_text(ended.out, "utf-8")
    assert load_profile(str(tmp_path / "a.toml")).id == "my-code"


@pytest.mark.parametrize(
    ("name", "says"),
    [("mine", "is there already and is left as it is"), ("a b", "an id has letters"), ("no/mine", "cannot be written")],
)
def test_new_refuses(command, mine, monkeypatch, name, says):
    """A file that is there stays as it is."""
    path = mine()
    monkeypatch.chdir(path.parent)
    ended = command("profiles", "new", name)
    assert (ended.status, ended.out) == (2, "")
    assert says in ended.err
    assert path.read_text("utf-8") == HEAD
    assert [file.name for file in path.parent.iterdir()] == ["mine.toml"]


@pytest.mark.parametrize(
    "arguments", [["list"], ["show", "iec61400-21"], ["check", "iec61400-21"], ["schema"], ["new"]], ids=" ".join
)
def test_no_compiler_is_loaded(arguments):
    """Reading profiles imports neither numba nor scipy nor plotly."""
    script = (
        "import sys\n"
        "from pvlvrt_compliance.cli.main import run\n"
        f"run(['profiles', *{arguments!r}])\n"
        "print(sorted({'numba', 'scipy', 'plotly', 'pandas', 'matplotlib'} & set(sys.modules)), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines()[-1] == "[]"


@pytest.fixture
def my_codes(monkeypatch, tmp_path):
    """A folder of one's own with a code that includes another, and a folder of its own for what is kept."""
    folder = tmp_path / "codes"
    folder.mkdir()
    text = (resource_folder("profiles") / "iec61400-21.toml").read_text("utf-8")
    (folder / "base.toml").write_text(text.replace('id = "iec61400-21"', 'id = "base"'), "utf-8")
    over = 'schema_version = 1\nid = "over"\ntitle = "Over"\ninclude = ["base"]\n'
    (folder / "over.toml").write_text(over, "utf-8")
    monkeypatch.setenv("PVLVRT_PROFILES", str(folder))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kept"))
    return folder


def listed(command):
    """The entries of the list by their names."""
    return {entry["name"]: entry for entry in json.loads(command("profiles", "list", "--json").out)}


@pytest.mark.usefixtures("my_codes")
def test_a_list_is_kept(command, monkeypatch):
    """The second list is that of the first, and reads no profile as a whole."""
    first = command("profiles", "list")
    monkeypatch.setattr(loading, "load_profile", None)
    assert command("profiles", "list") == first
    assert listed(command)["over"]["tests"] == listed(command)["base"]["tests"] > 0


def test_an_edit_of_what_a_profile_includes_is_listed(command, my_codes):
    """Each file that an entry is made from counts, whichever profile it is of."""
    before = listed(command)
    (my_codes / "over.toml").write_text((my_codes / "over.toml").read_text() + 'drop_tests = ["VD1*"]\n')
    base = my_codes / "base.toml"
    base.write_text(base.read_text("utf-8").replace('title = "', 'title = "Another ', 1), "utf-8")
    after = listed(command)
    assert after["base"]["title"] == f"Another {before['base']['title']}"
    assert 0 < after["over"]["tests"] < before["over"]["tests"]
    assert after["over"]["digest"] != before["over"]["digest"]


def test_a_file_that_comes_before_the_included_one_is_listed(command, my_codes, tmp_path, monkeypatch):
    """What is included lies beside the file or in an earlier folder; once another does, the list is another."""
    first = tmp_path / "first"
    first.mkdir()
    monkeypatch.setenv("PVLVRT_PROFILES", os.pathsep.join([str(first), str(my_codes)]))
    base = (my_codes / "base.toml").rename(first / "base.toml").read_text("utf-8")
    assert listed(command)["over"]["problems"] == []
    (my_codes / "base.toml").write_text(base.replace("schema_version = 1", "schema_version = 9"), "utf-8")
    after = listed(command)
    assert after["over"]["problems"]
    assert after["base"]["problems"] == []


def test_a_list_with_a_file_from_elsewhere_is_not_kept(command, my_codes, tmp_path):
    """A file that no folder of profiles has may change unseen, so such a list is made each time."""
    outside = tmp_path / "outside.toml"
    (my_codes / "base.toml").rename(outside)
    over = my_codes / "over.toml"
    over.write_text(over.read_text().replace('"base"', '"../outside.toml"'))
    before = listed(command)["over"]
    outside.write_text(outside.read_text("utf-8") + "unknown = 1\n", "utf-8")
    assert before["problems"] == []
    assert listed(command)["over"]["problems"]
