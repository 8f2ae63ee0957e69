"""What the grid did: asked for by a scenario, and found again in the record of it."""

import itertools

import numpy as np
import pytest

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.found import Thresholds, disturbance_found
from pvlvrt_compliance.disturbance.model import Disturbance, NormalVoltage
from pvlvrt_compliance.disturbance.words import describe_sag
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.collect import disturbance_of
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import asked_sequences_pu, entries
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
INNER = {"kind": "sag", "t_s": 0.2, "duration_s": 0.15, "sag": {"depth": 0.8}}
RAMP = {"kind": "voltage_profile", "points": [[0.1, 1.0], [0.3, 0.5], [0.3, 0.8], [0.5, 1.0]]}
JUMP = {"kind": "phase_jump", "t_s": 0.2, "angle_deg": 30}


def scenario_of(depth: float = 0.0, *events, duration_s: float = 0.6, **fields) -> Scenario:
    """A scenario with a sag of all phases and events."""
    phases = fields.pop("phases", "abc")
    return Scenario(sag=Sag(depth=depth, phases=phases), duration_s=duration_s, events=events, **fields)


def record_of(scenario: Scenario, dt_s: float = 1e-4) -> Waveforms:
    """Voltages of the source exactly as asked for."""
    table = entries(scenario)
    t = dt_s * np.arange(int(scenario.end_s / dt_s))
    here = np.searchsorted([entry.t_s for entry in table], t, side="right") - 1
    dt = t - np.array([entry.t_s for entry in table])[here]
    angle, f, rate = (np.array([e[k] for e in table])[here] for k in (1, 2, 3))
    at, slope = (np.array([getattr(e, name) for e in table])[here].T for name in ("sequences_pu", "slope_pu_s"))
    turning = np.exp(1j * (angle + 2 * np.pi * (f * dt + 0.5 * rate * dt**2)))
    u = phases(*(Nominal().phase_voltage_peak_v * (at + slope * dt)))
    return Waveforms((Segment(0.0, dt_s, {f"u_{p}_v": (x * turning).real for p, x in zip("abc", u, strict=True)}),))


@pytest.mark.parametrize(
    "scenario",
    [scenario_of(0.5), scenario_of(0.9, INNER, phases="a"), scenario_of(0, RAMP), scenario_of(0.3, RAMP, JUMP)],
)
def test_no_load_voltage_is_that_of_the_timeline(scenario):
    """At every instant of a record the amplitudes are those that the source is asked for."""
    asked = disturbance_asked(scenario, NORMAL)
    for t in np.linspace(0, scenario.end_s, 501):
        voltage, wanted = asked.no_load(float(t)), asked_sequences_pu(scenario, float(t))
        found = voltage.positive_pu, voltage.negative_pu, voltage.zero_pu
        assert found == pytest.approx([abs(x) for x in wanted], abs=1e-12)


def test_a_sag_within_a_sag_is_three_stretches_of_sag():
    """Steps and stretches follow what holds, each with its words and its kind."""
    asked = disturbance_asked(scenario_of(0.3, INNER), NORMAL)
    assert asked.voltage_steps_s == pytest.approx((0.3, 0.5, 0.65, 0.9))
    assert [part.kind for part in asked.stretches] == ["normal", "sag", "sag", "sag", "normal"]
    assert [round(part.voltage.positive_pu, 9) for part in asked.stretches] == [1, 0.7, 0.2, 0.7, 1]
    assert (asked.start_s, asked.clear_s, asked.end_s) == pytest.approx((0.3, 0.9, 0.9))
    assert asked.stretches[2].in_words.startswith("80 % in all three phases")
    assert not asked.is_normal(0.6)
    assert asked.is_normal(0.95)


def test_what_moves_is_named():
    """Each kind of event is a step of its own kind, where it begins and where it ends."""
    asked = disturbance_asked(
        scenario_of(
            0.0,
            JUMP,
            {"kind": "frequency_ramp", "t_s": 0.3, "rate_hz_s": 1.0, "duration_s": 0.1},
            {"kind": "grid_strength", "t_s": 0.45, "scr": 5.0, "xr": 10.0},
            {"kind": "irradiance", "t_s": 0.5, "to_w_m2": 500.0, "ramp_s": 0.05},
            {"kind": "harmonic", "order": 5, "amplitude_pu": 0.02, "t_s": 0.1},
        ),
        NORMAL,
    )
    assert [(round(step.at_s, 9), step.moved) for step in asked.steps] == [
        (0.4, ("harmonics",)),
        (0.5, ("angle",)),
        (0.6, ("frequency",)),
        (0.7, ("frequency",)),
        (0.75, ("strength",)),
        (0.8, ("irradiance",)),
        (0.85, ("irradiance",)),
    ]
    assert asked.frequency_moves
    assert asked.leaves_voltage_alone
    assert asked.jumps[0].positive_deg == pytest.approx(30)


def test_it_goes_through_json_unchanged():
    """A result carries the disturbance; nothing is lost on the way, and further keys do no harm."""
    asked = disturbance_asked(scenario_of(0.3, INNER, JUMP), NORMAL)
    assert Disturbance.model_validate_json(asked.model_dump_json()) == asked
    assert Disturbance.model_validate(asked.model_dump() | {"of_a_later_version": 1}) == asked


@pytest.mark.parametrize("name", sorted(known_profiles()))
def test_every_shipped_test_says_what_happens(name):
    """No shipped test in which something happens is without a step to mark, and none of them reads "sag: none"."""
    profile = load_profile(name, INSTALLED_KINDS)
    for test in profile.tests():
        asked = disturbance_of(profile, test)
        still = not test.scenario.sag.depth and not any(getattr(e, "t_s", 0) is not None for e in test.scenario.events)
        assert still or asked.steps, test.id
        says_none = ("sag", "none") in {(fact.name, fact.text) for fact in asked.facts}
        assert not (says_none and asked.steps), test.id


@pytest.mark.parametrize(
    "scenario",
    [
        scenario_of(0.5),
        scenario_of(0.9, phases="c"),
        scenario_of(0.3, INNER),
        scenario_of(0.0, {"kind": "voltage_profile", "points": [[0.1, 1.2], [0.4, 1.2], [0.4, 1.0]]}),
    ],
    ids=["sag", "phase-c", "sag-within-sag", "swell"],
)
def test_found_again_in_the_record(scenario):
    """The record of a scenario shows its steps within a cycle, and its levels."""
    asked = disturbance_asked(scenario, NORMAL)
    found = disturbance_found(record_of(scenario), Nominal(), Thresholds(NORMAL))
    assert found.origin == "found"
    assert found.voltage_steps_s == pytest.approx(asked.voltage_steps_s, abs=0.02)
    for seen, wanted in zip(found.stretches, asked.stretches, strict=True):
        assert seen.kind == wanted.kind
        assert seen.voltage.positive_pu == pytest.approx(wanted.voltage.positive_pu, abs=0.005)
        assert seen.voltage.negative_pu == pytest.approx(wanted.voltage.negative_pu, abs=0.005)


def test_a_sag_ends_when_the_voltage_moves_not_when_its_angle_does():
    """A jump within a sag cuts it in two stretches, and its end is still that of the sag, asked for or found."""
    scenario = scenario_of(0.5, JUMP)
    asked = disturbance_asked(scenario, NORMAL)
    found = disturbance_found(record_of(scenario), Nominal(), Thresholds(NORMAL))
    for seen in (asked, found):
        assert [part.kind for part in seen.stretches] == ["normal", "sag", "sag", "normal"]
        assert seen.clear_s == pytest.approx(0.9, abs=0.02)
        assert seen.end_s == seen.clear_s


def test_stretches_say_what_holds():
    """What begins is named; where nothing does, voltage and frequency are: no stretch of a sag reads as nothing."""
    step = {"kind": "frequency_step", "t_s": 0.55, "to_hz": 49.0}
    asked = disturbance_asked(scenario_of(0.0, RAMP, step), NORMAL)
    assert [part.in_words for part in asked.stretches] == [
        "normal grid",
        "voltage profile ramp from 0.1 s to 0.5 pu at 0.3 s; 0.8 pu from 0.3 s; ramp from 0.3 s to 1 pu at 0.5 s",
        "sag: V+ 0.800 to 1.000 pu, V- 0.000 to 0.000 pu",
        "normal grid",
        "frequency step to 49 Hz, at 0.55 s",
    ]
    back = disturbance_asked(scenario_of(0.5, step | {"t_s": 0.1}), NORMAL)
    assert back.stretches[-1].in_words == "normal voltage at 49 Hz"
    assert disturbance_asked(scenario_of(0.0), NORMAL).in_words == "no disturbance"


@pytest.mark.parametrize(
    ("sag", "words"),
    [
        (Sag(depth=0.9), "90 % in all three phases, 10 % left"),
        (Sag(depth=0.5, phases="c"), "50 % in phase c, 50 % left"),
        (Sag(depth=0.5, phases="bc"), "50 % in phases b and c, 50 % left"),
        (Sag(depth=0.5, phases="bc", two_phase=True), "50 % of the line-to-line voltage bc, 50 % left"),
        (Sag(depth=0, phases="a", angle_deg=60), "phase a, turned by +60 °"),
        (Sag(depth=0), "none"),
    ],
)
def test_a_sag_is_described(sag, words):
    """Depth, phases, and what is left of the voltage."""
    assert describe_sag(sag) == words


def test_a_voltage_that_falls_below_normal_in_a_stretch_is_a_sag_there():
    """A ramp down is no more normal than the ramp up after it."""
    asked = disturbance_asked(scenario_of(0.0, RAMP), NORMAL)
    assert [part.kind for part in asked.stretches] == ["normal", "sag", "sag", "normal"]


@pytest.mark.parametrize(
    ("scenario", "names"),
    [
        (scenario_of(0.5), ["sag"]),
        (scenario_of(0.05), ["voltage", "voltage"]),
        (scenario_of(0.5, JUMP), ["sag", "sag", "phase jump"]),
        (scenario_of(0.0, {"kind": "frequency_step", "t_s": 0.2, "to_hz": 49.0}), ["frequency"]),
    ],
    ids=["sag", "small-step", "jump-in-a-sag", "frequency"],
)
def test_what_is_found_is_told(scenario, names):
    """A disturbance that was found names all of it, as one that was asked for does."""
    found = disturbance_found(record_of(scenario), Nominal(), Thresholds(NORMAL))
    assert [fact.name for fact in found.facts] == names
    assert all(fact.text in found.in_words for fact in found.facts)


@pytest.mark.parametrize("angle_deg", [-60, -10, 10, 60])
def test_a_jump_of_the_angle_is_found(angle_deg):
    """A jump is neither a sag nor a frequency, and known to a tenth of a degree."""
    scenario = scenario_of(0.0, JUMP | {"angle_deg": angle_deg})
    found = disturbance_found(record_of(scenario), Nominal(), Thresholds(NORMAL))
    assert [step.moved for step in found.steps] == [("angle",)]
    assert found.jumps[0].at_s == pytest.approx(0.5, abs=0.02)
    assert found.jumps[0].positive_deg == pytest.approx(angle_deg, abs=0.1)


def test_a_frequency_that_moves_is_found():
    """A ramp of the frequency is a step where it leaves what it was, and moves no voltage."""
    ramp = {"kind": "frequency_ramp", "t_s": 0.2, "rate_hz_s": 2.0, "duration_s": 0.5}
    found = disturbance_found(record_of(scenario_of(0.0, ramp)), Nominal(), Thresholds(NORMAL))
    assert [step.moved for step in found.steps] == [("frequency",)]
    assert found.frequency_moves
    assert not found.voltage_steps_s


def test_a_record_without_disturbance_says_so():
    """Where nothing happens there is nothing to judge by."""
    with pytest.raises(MeasurementError, match="no disturbance"):
        disturbance_found(record_of(scenario_of(0.0)), Nominal(), Thresholds(NORMAL))


def test_stretches_cover_the_record_without_gaps():
    """What one stretch ends with, the next begins with, from the first instant to the last."""
    asked = disturbance_asked(scenario_of(0.3, INNER, RAMP, JUMP), NORMAL)
    assert asked.stretches[0].begin_s == 0
    assert asked.stretches[-1].end_s == pytest.approx(2.0)
    assert all(a.end_s == b.begin_s for a, b in itertools.pairwise(asked.stretches))


def test_a_profile_of_the_voltage_is_told_level_by_level():
    """A step is told once, with the level that it leads to; a level that holds is not told again."""
    points = [[0, 1.0], [0, 0.94], [10, 0.94], [10, 0.3], [11, 0.8], [12, 0.8]]
    asked = disturbance_asked(scenario_of(0.0, {"kind": "voltage_profile", "points": points}), NORMAL)
    assert asked.in_words == "voltage profile 0.94 pu from 0 s; 0.3 pu from 10 s; ramp from 10 s to 0.8 pu at 11 s"


@pytest.mark.parametrize(
    ("scenario", "says"),
    [
        (scenario_of(0.0), "no sag"),
        (scenario_of(0.5), "three-phase, 50 %"),
        (scenario_of(0.0, JUMP), "phase jump"),
        (scenario_of(0.3, INNER, INNER, JUMP), "three-phase, 30 %, 2 x sag, phase jump"),
    ],
)
def test_a_scenario_in_a_few_words(scenario, says):
    """Tables and titles never say that there is no sag where something else happens."""
    assert scenario.describe() == says


def test_a_copy_with_other_steps_has_its_own_stretches():
    """Nothing that was made of the old ones is in it."""
    grid = disturbance_asked(scenario_of(0.9), NORMAL)
    assert grid.voltage_steps_s == pytest.approx((0.3, 0.9))
    assert len(grid.following_stretches(2.0)) == 2
    shorter = grid.model_copy(update={"steps": grid.steps[:1], "stretches": grid.stretches[:2]})
    assert shorter.voltage_steps_s == pytest.approx((0.3,))
    assert len(shorter.following_stretches(2.0)) == 1
    assert shorter.stretch_at(5.0) == grid.stretches[1]
    assert grid.voltage_steps_s == pytest.approx((0.3, 0.9))


def test_a_record_is_searched_in_time_with_its_length(monkeypatch):
    """Twice as many sags in a record of twice the length: twice as many numbers are looked at, not four times."""
    looked_at = []

    def counted(name, place):
        right = getattr(np, name)

        def count(*arguments, **named):
            looked_at.append(np.size(arguments[place]))
            return right(*arguments, **named)

        monkeypatch.setattr(np, name, count)

    for name, place in (("isfinite", 0), ("median", 0), ("interp", 1), ("flatnonzero", 0)):
        counted(name, place)
    found = []
    for number in (30, 60):
        sags = [{"kind": "sag", "t_s": 0.2 * k, "duration_s": 0.1, "sag": {"depth": 0.5}} for k in range(number)]
        record = record_of(scenario_of(0.0, *sags, duration_s=0.2 * number))
        looked_at.clear()
        assert len(disturbance_found(record, Nominal(), Thresholds(NORMAL)).voltage_steps_s) == 2 * number
        found.append(sum(looked_at))
    assert found[1] < 2.5 * found[0]
