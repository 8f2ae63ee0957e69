"""Long lists of events: what is made of them takes n log n steps, and more than anybody waits for is refused."""

import itertools

import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.events import MOST_INSTANTS, MOST_PROFILES
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import busy_stretches, entries, irradiance_points
from steps import steps_of

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.05)

KINDS = {
    "sag": "t_s = {t}\nduration_s = {d}\nsag = {{ depth = 0.5, phases = 'a' }}",
    "phase_jump": "t_s = {t}\nangle_deg = 20",
    "frequency_step": "t_s = {t}\nto_hz = 49",
    "frequency_ramp": "t_s = {t}\nrate_hz_s = 0.001\nduration_s = {d}",
    "grid_strength": "t_s = {t}\nscr = 5",
    "harmonic": "t_s = {t}\norder = 5\namplitude_pu = 0.01\nduration_s = {d}",
    "irradiance": "t_s = {t}\nto_w_m2 = 800\nramp_s = {d}",
    "voltage_profile": "points = [[{t}, 1.0], [{t}, 0.9], [{t1}, 1.0]]",
}


def text_of(kinds, n, apart_s=0.001, lasts_s=0.01):
    """A file of so many events of some kinds, one after the other; each lasts into those that follow."""
    events = []
    for k, kind in zip(range(n), itertools.cycle(kinds), strict=False):
        t = round(k * apart_s, 6)
        content = KINDS[kind].format(t=t, t1=round(t + apart_s / 2, 7), d=lasts_s)
        events.append(f"[[events]]\nkind = '{kind}'\n{content}\n")
    return "\n".join(events)


def all_of_it(path):
    """Everything that is made of a file of events before a run, and for its report."""
    scenario = Scenario(sag=Sag(depth=0.3), duration_s=0.5, events=load_events(str(path)))
    entries(scenario), irradiance_points(scenario), busy_stretches(scenario)
    found = disturbance_asked(scenario, NORMAL)
    for part in found.stretches:
        found.stretch_at(part.begin_s), found.voltage_stretch(part.begin_s)
    return found


@pytest.mark.parametrize(
    ("kinds", "lasts_s"), [*(((kind,), 0.01) for kind in KINDS), (tuple(KINDS), 0.01), (tuple(KINDS), 30.0)]
)
def test_twice_as_many_take_little_more_than_twice_the_steps(kinds, lasts_s, tmp_path):
    """Of each kind, of all, and of all that last to the end: with the square of their number it would be four times."""
    steps = []
    for n in (80, 160):
        path = tmp_path / f"{n}.toml"
        path.write_text(text_of(kinds, n, lasts_s=lasts_s), "utf-8")
        all_of_it(path)  # what is made once a process is there
        steps.append(steps_of(lambda path=path: all_of_it(path)))
    assert steps[1] < 2.5 * steps[0]


def test_five_thousand_are_all_there(tmp_path):
    """A long list is used as it is written."""
    path = tmp_path / "many.toml"
    path.write_text(text_of(("phase_jump",), 5000), "utf-8")
    assert len(all_of_it(path).jumps) == 5000


def refused(text, tmp_path):
    """What a file is refused for, None when it is not."""
    path = tmp_path / "events.toml"
    path.write_text(text, "utf-8")
    try:
        load_events(str(path))
    except UsageError as error:
        return str(error)
    return None


@pytest.mark.parametrize(("more", "problem"), [(0, None), (1, f"{MOST_INSTANTS + 1} events and points")])
def test_so_many_instants_are_allowed(more, problem, tmp_path):
    """The last list that is used, and the first that is not: its number and what is allowed are said."""
    points = ", ".join(["[1, 1]"] * (MOST_INSTANTS - 2 + more))
    profile = f"[[events]]\nkind = 'voltage_profile'\npoints = [{points}]\n"
    found = refused(f"{profile}[[events]]\nkind = 'phase_jump'\nt_s = 0\nangle_deg = 1\n", tmp_path)
    assert found == problem or f":1: events: {problem}" in found
    assert found is None or f"{MOST_INSTANTS} are allowed" in found


@pytest.mark.parametrize(
    ("count", "apart_s", "problem"),
    [(MOST_PROFILES, 0.0, None), (MOST_PROFILES + 1, 0.0, f"{MOST_PROFILES + 1} voltage profiles"), (200, 1.0, None)],
)
def test_so_many_profiles_at_once(count, apart_s, problem, tmp_path):
    """Profiles that go on at one time are bounded; where each ends as the next begins they are not."""
    rows = (f"[[{k * apart_s}, 1], [{k * apart_s + 1}, 0.9]]" for k in range(count))
    found = refused("\n".join(f"[[events]]\nkind = 'voltage_profile'\npoints = {row}" for row in rows), tmp_path)
    assert found == problem or f"events: {problem} are under way at 0 s; {MOST_PROFILES} are allowed" in found


@pytest.mark.parametrize(
    ("event", "problem"),
    [
        ("kind = 'sag'\nt_s = 0\nduration_s = 3600\nsag = { depth = 0.5 }", None),
        ("kind = 'sag'\nt_s = 0\nduration_s = 3601\nsag = { depth = 0.5 }", ":4: events[0].duration_s: must be less"),
        ("kind = 'frequency_ramp'\nt_s = 0\nrate_hz_s = -15\nduration_s = 2", None),
        ("kind = 'frequency_ramp'\nt_s = 0\nrate_hz_s = -15\nduration_s = 2.1", "moves by 31.5 Hz; from 40 to 70 Hz"),
        ("kind = 'grid_strength'\nt_s = 0\nscr = 1e5\nxr = 1000", None),
        ("kind = 'grid_strength'\nt_s = 0\nscr = 1.1e5", "scr: must be less than or equal to 100000"),
        ("kind = 'grid_strength'\nt_s = 0\nscr = 5\nxr = 1001", "xr: must be less than or equal to 1000"),
        ("kind = 'grid_strength'\nt_s = 0\nscr = 5\nxr = 0.01", None),
        ("kind = 'grid_strength'\nt_s = 0\nscr = 5\nxr = 0.009", "xr: must be greater than or equal to 0.01"),
    ],
)
def test_what_an_event_may_be(event, problem, tmp_path):
    """Just inside and just outside of each range, with line, key and what is allowed."""
    found = refused(f"[[events]]\n{event}\n", tmp_path)
    assert found == problem or problem in found


def test_a_ramp_ends_the_ramp_before_it():
    """The frequency goes on from where it is, with the rate of the later ramp alone; so does the irradiance."""
    ramps = [("frequency_ramp", {"rate_hz_s": rate, "duration_s": 1.0}) for rate in (1.0, -2.0)]
    suns = [("irradiance", {"to_w_m2": to, "ramp_s": 1.0}) for to in (0.0, 700.0)]
    events = [{"kind": kind, "t_s": t, **rest} for t, (kind, rest) in zip((0, 0.5, 0, 0.5), ramps + suns, strict=True)]
    scenario = Scenario(sag=Sag(depth=0), duration_s=2.0, before_s=1.0, events=events)
    of_time = {round(entry.t_s - 1.0, 9): (entry.frequency_hz, entry.rocof_hz_s) for entry in entries(scenario)}
    assert [of_time[t] for t in (0.0, 0.5, 1.0, 1.5)] == [(50, 1), (50.5, -2), (49.5, -2), (48.5, 0)]
    assert irradiance_points(scenario)[1:] == [(1, 1000), (1.5, 500), (2.5, 700)]


def test_a_sag_that_has_ended_is_not_told():
    """Ends of sags are added up in one way, so that a stretch never names the sag that ended as it began."""
    for k in range(1, 60):
        begin_s, lasts_s = 0.01 * k, 0.07
        inner = {"kind": "sag", "t_s": begin_s, "duration_s": lasts_s, "sag": Sag(depth=0.31, phases="a")}
        asked = disturbance_asked(Scenario(sag=Sag(depth=0), duration_s=1.0, events=[inner]), NORMAL)
        after = next(part for part in asked.stretches if part.begin_s > 0.3 + begin_s + lasts_s / 2)
        assert after.in_words == "normal grid"
