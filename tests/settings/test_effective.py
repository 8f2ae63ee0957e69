"""What holds of what was typed, set in the environment, and written in a file."""

from pathlib import Path

import pytest

from pvlvrt_compliance.cli.options import SETTINGS, spelled
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.settings.effective import effective
from pvlvrt_compliance.settings.together import OF_A_SAG, OF_PROFILES
from pvlvrt_compliance.study import job


def test_the_nearest_counts(hold):
    """The command line counts before the environment, that before the file; lists are not joined."""
    text = 'profile = ["a", "b"]\nscr = 1\nxr = 1\ncsv = true\n'
    holds = hold(text, {"PVLVRT_PROFILE": "c", "PVLVRT_SCR": "2"}, profiles=["d"], csv=False)
    assert holds.given == {"profiles": ["d"], "scr": 2.0, "xr": 1.0, "csv": False}
    assert {name: value.origin for name, value in holds.values.items()} == {
        "profiles": "command line",
        "scr": "PVLVRT_SCR",
        "xr": "pvlvrt.toml:3",
        "csv": "command line",
    }


def test_a_message_names_what_was_written(hold):
    """A value from a file is named by its line, one from the environment by its variable, any other by its option."""
    spell = hold("xr = 1\n", {"PVLVRT_SCR": "2"}, sag="9%").spell(spelled)
    assert [spell(name) for name in ("xr", "scr", "sag", "tests")] == [
        "pvlvrt.toml:1 xr", "PVLVRT_SCR", "--sag", "--test",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "typed", "left", "aside"),
    [
        ('test = ["VD*"]', {"sag": "90%"}, {"sag"}, ["pvlvrt.toml:1 test is put aside: it does not go with --sag"]),
        (
            'sag = "9%"\nphases = "a"',
            {"tests": ["VD*"]},
            {"tests"},
            [
                "pvlvrt.toml:1 sag is put aside: it does not go with --test",
                "pvlvrt.toml:2 phases is put aside: it does not go with --test",
            ],
        ),
        (
            'controller = "a.py:A"\nmapping = "a.toml"',
            {"controller": "b.py:B"},
            {"controller"},
            ["pvlvrt.toml:2 mapping is put aside: it does not go with --controller"],
        ),
        (
            'profile = "a"\ntest = ["VD*"]\ncheck = ["x"]',
            {"profiles": ["b"]},
            {"profiles"},
            [
                "pvlvrt.toml:2 test is put aside: it does not go with --profile",
                "pvlvrt.toml:3 check is put aside: it does not go with --profile",
            ],
        ),
        ('test = ["VD*"]', {"profiles": ["b"]}, {"profiles", "tests"}, []),
        ('mapping = "a.toml"', {"controller": "b.py:B"}, {"controller", "mapping"}, []),
        (
            'sag = "9%"\nphases = "a"',
            {"two_phase": True},
            {"sag", "two_phase"},
            ["pvlvrt.toml:2 phases is put aside: it does not go with --two-phase"],
        ),
        ('controller = "a.py:A"', {"mapping": "b.toml"}, {"controller", "mapping"}, []),
        ('sag = "9%"\nphases = "a"', {"sag": "90%"}, {"sag", "phases"}, []),
        ('sag = "9%"\ntest = ["VD*"]', {}, {"sag", "tests"}, []),
        ('sag = "9%"', {"last_failed": False}, {"sag", "last_failed"}, []),
    ],
)
def test_what_does_not_go_with_what_was_typed(hold, text, typed, left, aside):
    """Of what does not go together the nearer stays, and what gives way is told; in one place it is refused later."""
    holds = hold(text, **typed)
    assert set(holds.values) == left
    assert list(holds.put_aside) == aside


def test_parameters_of_another_controller(hold):
    """What a file sets of its own controller is not said to one that was typed; all else holds."""
    text = 'controller = "a.py:A"\nset = ["controller.x=1", "sensors.adc_bits=12"]\n'
    assert hold(text).given["settings"] == ["controller.x=1", "sensors.adc_bits=12"]
    holds = hold(text, controller="b.py:B")
    assert holds.given == {"controller": "b.py:B", "settings": ["sensors.adc_bits=12"]}
    assert holds.put_aside == ("pvlvrt.toml:2 set controller.* is put aside: it does not go with --controller",)
    assert hold(text, controller="b.py:B", settings=["controller.y=1"]).put_aside == ()


def test_what_does_not_go_together_is_what_a_job_refuses():
    """The groups of fields are those of the job, which refuses them where nothing says which is nearer."""
    assert (("sag", *job._SAG_FIELDS), job._OF_PROFILES) == (OF_A_SAG, OF_PROFILES)


def test_isolated(project):
    """Neither file nor environment holds, whatever is wrong with them."""
    (project / "pvlvrt.toml").write_text("nonsense", "utf-8")
    holds = effective(SETTINGS, {"sag": "9%"}, {"PVLVRT_CSV": "x", "PVLVRT_Y": ""}, start=Path.cwd(), isolated=True)
    assert holds.given == {"sag": "9%"}
    assert (holds.in_words, holds.warnings, holds.provenance) == ("", (), {})


def test_a_file_that_is_named(project):
    """--config names any file, whoever may write it, and goes before $PVLVRT_CONFIG, that before the nearest."""
    (project / "pvlvrt.toml").write_text("scr = 1\n", "utf-8")
    for name, scr in (("ci.toml", 2), ("other.toml", 3)):
        (project / name).write_text(f"scr = {scr}\n", "utf-8")
        (project / name).chmod(0o666)
    environment = {"PVLVRT_CONFIG": "ci.toml"}
    assert effective(SETTINGS, {}, environment, start=Path.cwd()).given == {"scr": 2.0}
    assert effective(SETTINGS, {}, environment, start=Path.cwd(), config="other.toml").given == {"scr": 3.0}


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("none.toml", "none.toml: cannot be read: No such file"),
        ("pyproject.toml", "without a table"),
        ("sub/pyproject.toml", "cannot be read: No such file"),
    ],
)
def test_a_named_file_that_is_none(project, name, said):
    """What cannot be read, or has no settings, is told."""
    (project / "pyproject.toml").write_text('[project]\nname = "x"\n', "utf-8")
    with pytest.raises(UsageError, match=said):
        effective(SETTINGS, {}, {}, start=Path.cwd(), config=name)


def test_a_named_file_is_not_isolated():
    """The two contradict each other."""
    with pytest.raises(UsageError, match="--config names a file of settings, and --isolated none"):
        effective(SETTINGS, {}, {}, start=Path.cwd(), config="x.toml", isolated=True)


def test_in_words(hold):
    """A line names the file with its keys and the variables, but what the command line has replaced."""
    holds = hold("scr = 1\nxr = 2\n", {"PVLVRT_SAG": "9%"}, scr=3.0)
    assert holds.in_words == "settings of pvlvrt.toml (xr) and of the environment (PVLVRT_SAG)"
    assert hold("", {}, scr=3.0).in_words == "settings of pvlvrt.toml (of which nothing is used)"


def test_the_command_holds_without_the_file(hold):
    """What makes the run again has every value as an option, and takes no settings."""
    text = 'profile = "p"\nset = ["a.b=1", "a.c=2"]\ncsv = true\nquiet = false\npoint_on_wave = -90\n'
    words = hold(text, {}, sag="9%").command(["pvlvrt-check", "--sag", "9%"])
    assert " ".join(words) == (
        "pvlvrt-check --isolated --profile p --sag 9% --point-on-wave=-90 --set a.b=1 --set a.c=2 --csv"
    )


def test_typed_words_stay(hold):
    """Where neither file nor environment says anything, the command is what was typed."""
    assert hold(None, {}, sag="9%").command(["pvlvrt-check", "--sag=9%"]) == ("pvlvrt-check", "--sag=9%")


@pytest.mark.parametrize(
    "how",
    [["--jobs", "4"], ["--jobs=4"], ["--settle-once"], ["--no-settle-once"], ["--settle-once", "--jobs", "4"]],
    ids=" ".join,
)
def test_how_a_run_is_made_is_no_part_of_the_command(hold, how):
    """Options by which the results are the same go with their values; a flag has none, so that what follows stays."""
    typed = ["pvlvrt-check", *how, "--sag", "9%"]
    assert hold(None, {}, sag="9%").command(typed) == ("pvlvrt-check", "--sag", "9%")


def test_provenance(hold):
    """A run keeps its file by name and digest, and each value with where it comes from."""
    kept = hold("scr = 1\n", {"PVLVRT_SAG": "9%"}, xr=3.0).provenance
    assert kept["file"] == "pvlvrt.toml"
    assert kept["digest"] == "9d15db9488b4944c934342261ae3dbc58630233d0b49d202f52d324c75010806"
    assert kept["values"] == {
        "scr": {"value": 1.0, "from": "pvlvrt.toml:1"},
        "sag": {"value": "9%", "from": "PVLVRT_SAG"},
    }


ALL = """profile = "p"
controller = "a.py:A"
mapping = "m.toml"
scr = 3
sag = "9%"
phases = "a"
baseline = "b.txt"
baseline_tolerance = "2%"
check = ["x"]
"""


@pytest.mark.parametrize(
    ("back", "goes_with_it"),
    [
        ("controller", {"mapping"}),
        ("mapping", set()),
        ("scr", set()),
        ("sag", {"phases"}),
        ("phases", set()),
        ("baseline", {"baseline_tolerance"}),
        ("baseline_tolerance", set()),
        ("checks", set()),
    ],
)
def test_an_empty_value_takes_one_back(hold, back, goes_with_it):
    """The option is at its default then; what means nothing without it is put aside and told."""
    everything = hold(ALL).given
    holds = hold(ALL, **{back: [""] if back == "checks" else ""})
    assert holds.given == {name: value for name, value in everything.items() if name not in {back, *goes_with_it}}
    assert len(holds.put_aside) == len(goes_with_it)
    assert "" not in holds.command(["pvlvrt-check"])


def test_an_empty_value_that_takes_nothing_back(hold):
    """It is what was typed, for its option to refuse; of a variable it says nothing, so that the file's value stays."""
    assert hold("scr = 1\n", sag="").given == {"scr": 1.0, "sag": ""}
    assert hold('sag = "9%"\n', {"PVLVRT_SAG": ""}).given == {"sag": "9%"}
    assert hold("", {"PVLVRT_SAG": "9%"}, sag="").given == {}


def test_a_sag_that_is_taken_back_puts_no_tests_aside(hold):
    """It is no sag of one's own any more, so tests may be selected."""
    holds = hold('sag = "9%"\n', {"PVLVRT_TEST": "VD*"}, sag="")
    assert holds.given == {"tests": ["VD*"]}
    assert holds.put_aside == ()


def test_the_bundled_controller_by_its_name(hold):
    """It takes another one's place with all that was written for that, and in a file it is no path."""
    text = 'controller = "a.py:A"\nset = ["controller.x=1"]\n'
    holds = hold(text, {"PVLVRT_MAPPING": "m.toml"}, controller="bundled")
    assert holds.given == {"controller": "bundled", "settings": []}
    assert len(holds.put_aside) == 2
