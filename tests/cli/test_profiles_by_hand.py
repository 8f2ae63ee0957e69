"""`pvlvrt-check profiles check`, `schema` and `new`: profiles that somebody writes."""

import json
import tomllib

import jsonschema
import pytest

from profile_files import HEAD, SHIPPED
from pvlvrt_compliance.profile import known_profiles, load_profile
from pvlvrt_compliance.profile.beginning import placeholders


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
