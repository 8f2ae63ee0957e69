"""`pvlvrt-check profiles`: list, show, plot, check, schema, new."""

import json
import re
import sys
import xml.etree.ElementTree as ET

import pytest

from profile_files import HEAD, SHIPPED
from pvlvrt_compliance.data.marks import marks_in
from pvlvrt_compliance.profile import load_profile

COMMANDS = ("list", "show", "plot", "check", "schema", "new")


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
