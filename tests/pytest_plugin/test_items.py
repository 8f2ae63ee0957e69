"""A file of settings as tests."""

import tomllib
from pathlib import Path

import pytest

from pvlvrt_compliance import pytest_plugin
from pvlvrt_compliance.results import Status, TestResult, Verdict, worst
from pvlvrt_compliance.simulation import simulate  # noqa: F401 - loaded before pytest is run within pytest
from pvlvrt_compliance.study.one_by_one import OneByOne

pytest_plugins = ["pytester"]

SETTINGS = 'profile = "iec61400-21"\ntest = ["VD3-full*"]\n'


def verdict(status, **fields):
    """A verdict with every number that one may have."""
    numbers = {"measured": 91.4, "limit": 107.1, "bound": "at_least", "margin": -15.7, "unit": "kvar"}
    more = {"clause": "eq (9)", "message": "too little", **numbers} | fields
    return Verdict(check="reactive_support", status=status, **more)


@pytest.fixture
def finding(monkeypatch):
    """What is found in tests: ``finding(*verdicts, of=id)``; all others pass."""
    by_id = {}

    def results(_, item):
        checks = by_id.get(item.test.id, (verdict(Status.PASS),))
        status = worst(check.status for check in checks)
        return (TestResult(id=item.test.id, profile=item.profile.id, status=status, checks=checks),)

    monkeypatch.setattr(OneByOne, "results", results)
    return lambda *verdicts, of="VD3-full-1": by_id.update({of: verdicts})


def test_pytest_finds_the_plugin():
    """The package announces it by the name that switches it off, ``-p no:pvlvrt``."""
    table = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))
    assert table["project"]["entry-points"]["pytest11"] == {"pvlvrt": pytest_plugin.__name__}


def test_one_item_a_test(project):
    """Each test of the profiles that the file selects, by the id that results have; nothing is simulated for that."""
    ended = project(SETTINGS, "--collect-only", "-q")
    ended.stdout.fnmatch_lines(
        [
            "pvlvrt-check: settings of *pvlvrt.toml (profile, test)",
            "pvlvrt.toml::iec61400-21.VD3-full-1",
            "pvlvrt.toml::iec61400-21.VD3-full-2",
            "*2 tests collected*",
        ]
    )


def test_selected_by_id(project, finding):
    """An item is selected as any other: by its id, by -k, by its mark."""
    finding(verdict(Status.PASS))
    for arguments in (["pvlvrt.toml::iec61400-21.VD3-full-2"], ["-k", "full-2"]):
        project(SETTINGS, *arguments).assert_outcomes(passed=1, deselected="-k" in arguments)
    project(SETTINGS, "-m", "not pvlvrt").assert_outcomes(deselected=2)
    ended = project(None, "-v")
    ended.stdout.fnmatch_lines(["pvlvrt.toml::iec61400-21.VD3-full-1 PASSED*"])


@pytest.mark.parametrize("settings", [None, "", 'controller = "a.py:A"\n'])
def test_without_a_profile_there_is_nothing(project, settings):
    """Projects without a file, or with one that selects nothing, notice nothing of the plugin."""
    ended = project(settings, test_own="def test_own(): pass")
    ended.assert_outcomes(passed=1)
    assert "pvlvrt" not in ended.stdout.str().replace("pvlvrt_compliance.pytest_plugin", "")


def test_a_named_file_without_a_profile_is_told(project):
    """What was asked for and cannot be is an error."""
    ended = project('sag = "50%"\n', "pvlvrt.toml")
    ended.assert_outcomes(errors=1)
    ended.stdout.fnmatch_lines(["*--profile is missing; known profiles:*"])


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ("profile = 5\n", "*pvlvrt.toml:1: profile: must be a text or a list of texts, not 5"),
        ('profile = "iec"\n', "unknown profile 'iec'*"),
        (SETTINGS.replace("VD3", "VX"), "*pvlvrt.toml:2 test VX-full?: no test of this name*"),
    ],
)
def test_a_file_that_cannot_be_used_is_an_error(project, settings, said):
    """With the words that the command has for it."""
    ended = project(settings)
    ended.assert_outcomes(errors=1)
    ended.stdout.fnmatch_lines([said])


def test_a_file_of_somebody_else_is_an_error(project, pytester, monkeypatch):
    """Met on the way it may name anybody's code; named on the command line it is meant."""
    pytester.makefile(".toml", pvlvrt=SETTINGS)
    (pytester.path / "pvlvrt.toml").chmod(0o666)
    ended = project(None, "--collect-only", "-q")
    ended.assert_outcomes(errors=1)
    ended.stdout.fnmatch_lines(["*pvlvrt.toml is not used: anybody may write it*; pytest pvlvrt.toml uses it*"])
    project(None, "--collect-only", "-q", "pvlvrt.toml").stdout.fnmatch_lines(["*2 tests collected*"])
    monkeypatch.setenv("PVLVRT_CONFIG", "pvlvrt.toml")
    project(None, "--collect-only", "-q").stdout.fnmatch_lines(["*2 tests collected*"])


def test_a_project_file_only_when_it_is_named(project, pytester):
    """A pyproject.toml is in every project: its table is a file of tests where somebody asks for it."""
    pytester.makepyprojecttoml('[tool.pvlvrt]\nprofile = "iec61400-21"\ntest = "VD3-full-1"\n')
    project(None, "--collect-only", "-q").stdout.fnmatch_lines(["*no tests collected*"])
    project(None, "--collect-only", "-q", "pyproject.toml").stdout.fnmatch_lines(
        ["pyproject.toml::iec61400-21.VD3-full-1"]
    )
    pytester.makepyprojecttoml('[project]\nname = "x"\n')
    ended = project(None, "pyproject.toml")
    ended.stdout.fnmatch_lines(["*there is no table ?tool.pvlvrt?*"])


def test_a_failure_tells_the_verdict(project, finding):
    """What failed is named first, then its reason, measured value, limit, margin clause; no code is shown."""
    finding(verdict(Status.FAIL), Verdict(check="dc_ripple", status=Status.PASS))
    ended = project(SETTINGS)
    ended.assert_outcomes(failed=1, passed=1)
    ended.stdout.fnmatch_lines(
        [
            "*_ VD3-full-1 of iec61400-21 _*",
            "reactive_support fail",
            "iec61400-21.VD3-full-1, reactive_support: too little",
            "    measured 91.4 kvar; limit at least 107.1 kvar; margin -15.7 kvar; clause eq (9)",
            "FAILED pvlvrt.toml::iec61400-21.VD3-full-1 - reactive_support fail",
        ]
    )
    assert "dc_ripple" not in ended.stdout.str()
    assert "collecting.py" not in ended.stdout.str()


UNJUDGED = verdict(Status.NOT_EVALUATED, measured=None, limit=None, margin=None)


@pytest.mark.parametrize(
    ("verdicts", "outcome"),
    [
        ((verdict(Status.PASS),), "passed"),
        ((verdict(Status.PASS), verdict(Status.NOT_APPLICABLE)), "passed"),
        ((verdict(Status.PASS), verdict(Status.FAIL)), "failed"),
        ((verdict(Status.ERROR),), "failed"),
        ((UNJUDGED,), "failed"),
        ((verdict(Status.PASS), UNJUDGED), "failed"),
        ((verdict(Status.NOT_APPLICABLE),), "skipped"),
        ((verdict(Status.PASS), verdict(Status.FAIL, known=True, known_reason="a wish")), "xfailed"),
        ((verdict(Status.FAIL, known=True), verdict(Status.FAIL)), "failed"),
        ((verdict(Status.FAIL, worse="margin -15.7, before -3"),), "failed"),
    ],
)
def test_outcomes(project, finding, verdicts, outcome):
    """Red is what ends the command with another status than 0; known failures are expected ones."""
    finding(*verdicts)
    outcomes = {"passed": 1}
    outcomes[outcome] = outcomes.get(outcome, 0) + 1
    project(SETTINGS).assert_outcomes(**outcomes)


@pytest.mark.parametrize(
    ("verdicts", "outcome"), [((verdict(Status.PASS), UNJUDGED), "passed"), ((UNJUDGED,), "skipped")]
)
def test_what_may_stay_unjudged(project, finding, verdicts, outcome):
    """With allow_unjudged it makes nothing red; where nothing else was judged, the test is skipped and not passed."""
    finding(*verdicts)
    outcomes = {"passed": 1}
    outcomes[outcome] = outcomes.get(outcome, 0) + 1
    project(f"{SETTINGS}allow_unjudged = true\n").assert_outcomes(**outcomes)


def test_reasons_of_what_is_not_run_or_expected(project, finding):
    """A known failure is told with the reason that the baseline has, and why nothing was judged, too."""
    finding(verdict(Status.FAIL, known=True, known_reason="a wish"))
    finding(verdict(Status.NOT_APPLICABLE, message="the code lets it go"), of="VD3-full-2")
    ended = project(SETTINGS, "-rsx")
    ended.stdout.fnmatch_lines(["XFAIL *VD3-full-1 - reactive_support: known failure: a wish"])
    ended.stdout.fnmatch_lines(["SKIPPED *nothing was judged: reactive_support: the code lets it go"])


def test_last_failed_and_fail_fast(project, finding):
    """What pytest has for these holds; the settings of the same kind are of the command."""
    finding(verdict(Status.FAIL))
    project(f"{SETTINGS}fail_fast = false\nlast_failed = true\n", "-x").assert_outcomes(failed=1)
    ended = project(SETTINGS, "--lf")
    ended.assert_outcomes(failed=1)
    ended.stdout.fnmatch_lines(["run-last-failure: rerun previous 1 failure"])


@pytest.mark.slow
def test_a_real_run(project, monkeypatch):
    """Tests are simulated and judged, in this process or by xdist in others, by what file and environment say."""
    monkeypatch.setenv("PVLVRT_TEST", "VD3-full-1")
    project(SETTINGS, "pvlvrt.toml").assert_outcomes(passed=1)
    monkeypatch.setenv("PVLVRT_SET", "controller.reactive_plateau_pu=0")
    ended = project(SETTINGS, "-n", "1", in_process=False)
    ended.assert_outcomes(failed=1)
    ended.stdout.fnmatch_lines(["FAILED pvlvrt.toml::iec61400-21.VD3-full-1 - reactive_support fail"])
