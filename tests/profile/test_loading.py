"""Loading: names and paths, includes, and every problem of a file at once."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import ProfileError, PvlvrtError, UsageError
from pvlvrt_compliance.profile import known_profiles, load_profile

NUMBER = '{{ value = {}, confidence = "chosen", source = "a test" }}'


def problems_of(path: str) -> tuple[str, ...]:
    """Problems that loading a file raises, which must name the file first."""
    with pytest.raises(ProfileError) as caught:
        load_profile(path)
    assert "mine.toml" in str(caught.value).splitlines()[0]
    return caught.value.problems


@pytest.mark.parametrize("name", ["iec61400-21", "spain-q-curve"])
def test_shipped_profiles_load(name):
    """Every profile that ships loads and is named as its file."""
    assert name in known_profiles()
    assert load_profile(name).id == name


def test_unknown_name():
    """An unknown name is answered with the near misses and the known ones."""
    with pytest.raises(UsageError, match=r'unknown profile \'iec6140-21\'; did you mean "iec61400-21".*spain-q-curve'):
        load_profile("iec6140-21")


@pytest.mark.parametrize("path", ["nowhere.toml", "no/where", "a\0b.toml", "x" * 5000 + ".toml"])
def test_no_such_file(path):
    """A path without a file is a usage error that names the shipped profiles."""
    with pytest.raises(UsageError, match=r"iec61400-21, .*spain-q-curve"):
        load_profile(path)


def test_a_folder_is_no_profile(tmp_path):
    """A folder's path is refused like a file that is not there."""
    with pytest.raises(UsageError):
        load_profile(f"{tmp_path}/")


def test_include_wins_over_what_it_includes(write):
    """A file changes one number of an included profile and keeps all others."""
    limit = "[requirements.dc_ripple.limit_percent]\nvalue = 0.3\nconfidence = 'chosen'\nsource = 'a test'\n"
    mine, shipped = load_profile(write(limit)), load_profile("iec61400-21")
    assert mine.requirements.dc_ripple.limit_percent.value == 0.3
    assert mine.requirements.reactive_support == shipped.requirements.reactive_support
    assert mine.envelope == shipped.envelope
    assert len(mine.tests()) == len(shipped.tests())


def test_includes_are_looked_for_beside_the_file(write):
    """A bare name and a path both reach a neighbour."""
    write(name="base")
    for include in ('["base"]', '["base.toml"]', '["./base.toml"]'):
        assert load_profile(write(include=include)).tests()


def test_house_style_of_an_error(write):
    """An error names the file, the number of problems, and for each its key and what is allowed."""
    path = write(
        """
        [requirements.ride_through]
        claus = "x"
        [requirements.ride_through.envelope]
        points = [[0, 0], [0.15, 0.1], [0.10, 0.2]]
        """
    )
    with pytest.raises(ProfileError) as caught:
        load_profile(path)
    assert str(caught.value).splitlines() == [
        f"{path}: 2 problems",
        f"  {path}:9: requirements.ride_through.envelope.points: times must not decrease: 0.15 s is followed by 0.1 s",
        f'  {path}:7: requirements.ride_through.claus: unknown key; did you mean "clause"?',
    ]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[conditions]\nfoo = 1", "conditions.foo: unknown key; allowed: starting_power_fraction, "),
        ("[requirement]\n", 'requirement: unknown key; did you mean "requirements"?'),
        (
            "[requirements.current_limits]\n",
            'requirements.current_limits: unknown key; did you mean "current_limit"?',
        ),
        ("[requirements.dc_ripple.limit_percent]\nvalue = '0.2'", "limit_percent.value: must be a number, not '0.2'"),
        ("[requirements.dc_ripple.limit_percent]\nvalue = true", "limit_percent.value: must be a number, not True"),
        ("[requirements.dc_ripple.limit_percent]\nvalue = nan", "limit_percent.value: must be a finite number"),
        ("[requirements.dc_ripple.limit_percent]\nvalue = -inf", "limit_percent.value: must be a finite number"),
        ("[requirements.dc_ripple.limit_percent]\nvalue = -1", "limit_percent: must be above 0, not -1"),
        ("[requirements.dc_ripple.limit_percent]\nvalue = 1979-05-27", "limit_percent.value: must be a number"),
        ("[requirements.dc_ripple.limit_percent]\nsource = ''", "limit_percent.source: must not be empty"),
        (
            "[requirements.dc_ripple.limit_percent]\nconfidence = 'sure'",
            "limit_percent.confidence: must be 'confirmed'",
        ),
        ("[requirements.dc_ripple]\nlimit_percent = 0.2", "limit_percent: must be a table, not 0.2"),
        ("[requirements.ride_through]\nrecovery_fraction.value = 95", "must be above 0 and at most 1, not 95"),
        ("[requirements.current_limit]\nsettling_s.value = -0.1", "settling_s: must be 0 or above, not -0.1"),
        ("[requirements.ride_through.envelope]\npoints = []", "envelope.points: "),
        ("[requirements.ride_through.envelope]\npoints = [[0, 0], [1, '2']]", "points[1][1]: must be a number"),
        ("[requirements.ride_through.envelope]\npoints = [[0, 0], [1]]", "points[1][1]: missing"),
        ("[requirements.ride_through.envelope]\npoints = [[0.1, 0]]", "the first point must be at 0 s"),
        ("[requirements.ride_through.envelope]\npoints = [[0, -0.1]]", "levels must lie between 0 and 2 pu"),
        ("[requirements.ride_through.envelope]\ninterpolation = 'cubic'", "must be 'linear' or 'step'"),
        ("[requirements.reactive_support.curve]\npoints = [[0, 1], [0, 0]]", "voltages must increase"),
        ("[requirements.reactive_support]\nclip_to_capability.value = 1", "must be true or false, not 1"),
        ("[procedure]\nafter_s.value = 0", "procedure.after_s: must be above 0, not 0"),
        ("[procedure.irradiance_w_m2]\nfull = 3", "procedure.irradiance_w_m2.full: must be a table, not 3"),
        ("[procedure]\npoints_on_wave_deg.values = []", "points_on_wave_deg.values: "),
        ("[windows]\nduring_start_s.value = -1", "windows.during_start_s: must be 0 or above"),
        ("title2 = 1", 'title2: unknown key; did you mean "title"?'),
        ("tests = 3", "tests: must be a list of tables, [[tests]], not 3"),
    ],
)
def test_wrong_values(write, text, problem):
    """Each wrong value is named by its key, with what is allowed."""
    assert any(problem in line for line in problems_of(write(text)))


ROW = """
[[tests]]
id = "T"
clause = "c"
sag = {{ depth = 0.5 }}
duration_s = 0.5
powers = ["full"]
confidence = "memory"
source = "a test"
{}
"""


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("duration_s = 0.5", "duration_s = -0.5", 'duration_s: must be a time above 0 s, or "envelope", not -0.5'),
        ("duration_s = 0.5", "duration_s = 'long'", "must be a time above 0 s, or \"envelope\", not 'long'"),
        ("duration_s = 0.5", "duration_s = 1e9", "duration_s: must be less than or equal to 3600"),
        ("duration_s = 0.5", "", "duration_s: missing"),
        ("depth = 0.5", "depth = 1.5", "sag.depth: must be less than or equal to 1, not 1.5"),
        ("depth = 0.5", "depth = 0.5, phases = 'a', two_phase = true", "sag: a two-phase sag needs a pair of phases"),
        ("depth = 0.5", "depht = 0.5", 'sag.depht: unknown key; did you mean "depth"?'),
        ('"full"', '"ful"', "powers: 'ful' is not in procedure.irradiance_w_m2; it has: full, partial"),
        ('"full"', "", "powers: "),
        ('"T"', '"VD1"', None),
        ('"T"', '"a b"', "id: "),
        ("", "points_on_wave_deg = [720]", "point_on_wave_deg: must be less than or equal to 360"),
    ],
)
def test_wrong_rows_of_the_test_table(write, old, new, problem):
    """A row that cannot be run is refused when the profile is loaded, by its place in the table."""
    text = ROW.format("").replace(old, new, 1) if old else ROW.format(new)
    if problem is None:
        load_profile(write(text))
        return
    assert any(": tests[0]." in line and problem in line for line in problems_of(write(text)))


def test_ids_occur_once(write):
    """Two tests of one id are refused."""
    text = ROW.format("points_on_wave_deg = [0]") * 2
    path = write(text)
    assert problems_of(path) == (f"{path}:17: tests[1].id: the id 'T' occurs twice",)


def test_envelope_duration_without_an_envelope(write):
    """A test that lasts by the envelope needs one."""
    powers = f"[procedure.irradiance_w_m2]\nfull = {NUMBER.format(1000)}\n"
    text = powers + ROW.format("").replace("duration_s = 0.5", 'duration_s = "envelope"')
    path = write(text, include='["spain-q-curve"]')
    (problem,) = problems_of(path)
    assert problem == f'{path}:12: tests[0].duration_s: "envelope" needs requirements.ride_through.envelope'


@pytest.mark.parametrize("version", ["2", "'1'", "true", "1.5"])
def test_wrong_schema_version(write, version):
    """A schema version that this program does not read is named with the one it reads, beside all other problems."""
    head = f'schema_version = {version}\nid = "{{name}}"\ntitle = "t"\n'
    problems = problems_of(write("[conditions]\nfoo = 1", head=head))
    assert ":1: schema_version: " in problems[0]
    assert problems[0].endswith("this version of the program reads 1")
    assert len(problems) == 2


def test_missing_schema_version_of_an_included_file(write):
    """Each file states its own schema version; the problem names the file that does not."""
    write(name="base", head='id = "base"\ntitle = "t"\n')
    (problem,) = problems_of(write(include='["base"]'))
    assert "base.toml:1: schema_version: missing" in problem


def test_problem_of_an_included_file_names_it(write):
    """A wrong value that an included file brought in is shown with that file."""
    write("[conditions]\nfoo = 1\n", name="base")
    (problem,) = problems_of(write("[windows]\n", include='["base"]'))
    assert "base.toml:6: conditions.foo: unknown key" in problem


def test_missing_parts(write):
    """A file with nothing but its head lacks the parts that every profile has."""
    path = write(include="")
    missing = {line for line in problems_of(path) if line.endswith(": missing")}
    assert missing == {f"{path}:1: {part}: missing" for part in ("requirements", "conditions", "procedure")}


@pytest.mark.parametrize(
    ("include", "problem"),
    [
        ('["nowhere"]', ":4: include[0]: there is no profile 'nowhere'"),
        ('["iec61400"]', 'did you mean "iec61400-21"'),
        ('["below/nowhere.toml"]', ":4: include[0]: there is no profile 'below/nowhere.toml'"),
        ('"iec61400-21"', "include: must be a list"),
        ("[1]", "include: must be a list"),
        ('["mine"]', "without end: mine.toml includes mine.toml"),
    ],
)
def test_wrong_includes(write, include, problem):
    """An include that leads nowhere, or back, is named."""
    assert any(problem in line for line in problems_of(write(include=include)))


def test_include_loop_over_two_files(write):
    """Files that include one another are refused with the way round."""
    write(name="other", include='["mine"]')
    path = write(include='["other"]')
    with pytest.raises(ProfileError, match=r"mine\.toml includes other\.toml includes mine\.toml"):
        load_profile(path)


def test_broken_toml_has_line_and_column(write):
    """A syntax error is shown with its place."""
    (problem,) = problems_of(write("[conditions\n"))
    assert "line 5, column" in problem


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"\xff\xfe", "not UTF-8"),
        (b"# " + b"x" * (1 << 20), "larger than 1 MiB"),
        (b"a = " + b"[" * 20000, "not TOML"),
        (b"a = " + b"9" * 5000, "not TOML"),
        (b"", "schema_version: missing"),
    ],
)
def test_files_that_are_no_profiles(tmp_path, content, problem):
    """Whatever a file holds, the answer is a profile error."""
    file = tmp_path / "mine.toml"
    file.write_bytes(content)
    assert any(problem in line for line in problems_of(str(file)))


@draws(60)
@given(st.recursive(st.none() | st.booleans() | st.integers() | st.text(max_size=5), lambda x: st.lists(x, max_size=3)))
def test_no_value_crashes_the_loader(tmp_path_factory, value):
    """Any TOML value in any place either loads or is a profile error, never another exception."""
    file = tmp_path_factory.mktemp("p") / "mine.toml"
    literal = "[]" if value is None else json.dumps(value)
    file.write_text(
        'schema_version = 1\nid = "m"\ntitle = "t"\ninclude = ["iec61400-21"]\n'
        f"windows = {literal}\ntests = {literal}\nprocedure.irradiance_w_m2 = {literal}\nconditions.x = 1\n"
    )
    with pytest.raises(PvlvrtError):
        load_profile(str(file))
