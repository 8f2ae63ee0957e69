"""Wrong controllers drawn from a seed, run through the simulator, judged by a profile and by the plain sentences."""

import random
from collections.abc import Iterator, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import sentences as say
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.run import Simulator, run_test
from seen import Level, record_of
from validation.mutations.slips import NO_SLIP, Slip, What, When
from validation.mutations.wrong_controllers import wrong_run


class Code(NamedTuple):
    """What of a profile is said in plain sentences, and which sags it is tried in."""

    sentences: tuple[say.Sentence, ...]
    lowest_pu: float  # of three phases
    one_phase: bool = True  # sags of one phase, too
    frequency_hz: float = 50.0
    settings: tuple[str, ...] = ()  # with which the right controller passes


def _a_second(_: Level) -> float:
    return 1.0


def _by_depth(sag: Level) -> float:
    return 1.1 if sag.v_positive > 0.51 else 2.1


_EVERYWHERE = (say.stays_connected, say.does_not_swing)
_PAPER = (
    *_EVERYWHERE,
    say.feeds_from(0.0),
    say.comes_back(0.95, _a_second),
    say.ends_as_before(None, 0.06),
    say.limits_current(1.05, 1.25, 2.1),
    say.supports,
    say.no_support_while_normal,
    say.feeds_power_in_sags,
    say.quiet_link(0.25),
)

CODES = {
    "spain-q-curve": Code(_PAPER, 0.3),
    "iec61400-21": Code(_PAPER, 0.3),
    "es-po-12.3": Code(
        (*_EVERYWHERE, say.feeds_from(0.0), say.comes_back(0.95, _a_second), say.shares, say.takes_nothing), 0.3
    ),
    "dk-rfg": Code((*_EVERYWHERE, say.feeds_from(0.0), say.ends_as_before(0.07, 0.07)), 0.4),
    "es-nts-631-ge110kv": Code(
        (
            *_EVERYWHERE,
            say.feeds_from(0.25),
            say.comes_back(0.95, _by_depth),
            say.adds_reactive_current(3.5, 0.15),
            say.comes_soon(3.5, 0.08),
        ),
        0.4,
        one_phase=False,
        settings=("controller.reactive_plateau_pu=2.5",),
    ),
    "nerc-prc-029": Code(
        (
            *_EVERYWHERE,
            say.feeds_from(0.12),
            say.comes_back(0.95, _a_second),
            say.goes_on_feeding(0.50, 0.12, apparent=False, from_s=0.067),
        ),
        0.4,
        frequency_hz=60.0,
    ),
    "ieee1547-cat-ii": Code(
        (
            *_EVERYWHERE,
            say.feeds_from(0.66, after_a_pause_s=0.45),
            say.comes_back(0.80, lambda _: 0.4),
            say.goes_on_feeding(0.80, 0.66, apparent=True, from_s=0.034),
            say.steady_harmonics(0.06),
            say.no_direct_current(0.01),
        ),
        0.67,
        one_phase=False,
        frequency_hz=60.0,
    ),
}
"""By the id of the profile."""

_CALM_PU = (0.56, 0.60)
"""Levels that are left out: there the slope of eq (10) has no end, and the right controller is not calm."""


GRIDS = {
    "sag within sag": ((0.0, 0.6, "abc", 0.7), (0.2, 0.4, "abc", 0.4)),
    "inner sag outlasts": ((0.0, 0.4, "abc", 0.7), (0.2, 0.6, "abc", 0.45)),
    "restrike": ((0.0, 0.15, "abc", 0.5), (0.2, 0.4, "abc", 0.5)),
    "swell after sag": ((0.0, 0.25, "abc", 0.5), (0.25, 0.5, "abc", 1.09)),
    "spreads": ((0.0, 0.4, "c", 0.3), (0.15, 0.4, "abc", 0.5)),
    "fifteen faults": tuple(
        (round(0.4 * k, 3), round(0.4 * k + 0.12, 3), ("abc", "c")[k % 2], (0.5, 0.3)[k % 2]) for k in range(15)
    ),
}
"""What the right controller goes through: begin and end (s), phases, level (pu)."""


class Trial(NamedTuple):
    """One controller in one test of one profile."""

    profile: str
    levels: tuple[tuple[float, float, str, float], ...]  # begin, end (s, from the first), phases, level (pu)
    slip: Slip
    point_on_wave_deg: float
    as_row: bool = False  # ridden through as a whole, as a row of a table demands
    after_s: float = 1.3

    @property
    def in_words(self) -> str:
        grid = "; ".join(f"{phases} {pu:g} pu {begin:g} to {end:g} s" for begin, end, phases, pu in self.levels)
        demand = "a row" if self.as_row else "an own sag"
        return f"{self.profile}, {demand}, {grid}, {self.point_on_wave_deg:g} deg: Slip({self.slip.in_words})"


class Outcome(NamedTuple):
    """What the profile and the sentences say."""

    result: TestResult
    broken: tuple[str, ...]

    @property
    def is_let_through(self) -> bool:
        """Whether the profile passes what the sentences say is broken."""
        return bool(self.broken) and self.result.status in {Status.PASS, Status.NOT_APPLICABLE}

    @property
    def failed(self) -> set[str]:
        return {check.check for check in self.result.checks if check.status is Status.FAIL}


def drawn(seed: int, count: int) -> Iterator[Trial]:
    """Trials, the same for the same seed."""
    chance = random.Random(seed)
    for _ in range(count):
        name = chance.choice(list(CODES))
        levels = _levels(chance, CODES[name])
        yield Trial(name, levels, _slip(chance, levels), chance.choice((0.0, 30.0, 90.0)), chance.random() < 0.3)


def _levels(chance: random.Random, code: Code) -> tuple[tuple[float, float, str, float], ...]:
    """Two sags, a sag with an inner level, or a sag and a swell; two sags and a gap of a second now and then."""
    first, second = _depth(chance, code), _depth(chance, code)
    lasts, again = chance.choice((0.2, 0.25, 0.3)), chance.choice((0.2, 0.25, 0.3))
    shape = chance.choice(("two", "two", "far apart", "inner", "swell"))
    if shape == "inner":
        phases = first[0] if first[0] == second[0] else "abc"
        outer, inner = (first[1], second[1]) if first[0] == second[0] else (0.75, 0.68)
        return (0.0, 0.2 + again + 0.2, phases, outer), (0.2, 0.2 + again, phases, inner)
    if shape == "swell":
        gap = chance.choice((0.3, 0.5))
        return (0.0, lasts, *first), (lasts + gap, lasts + gap + again, "abc", 1.08)
    gap = 1.25 if shape == "far apart" else chance.choice((0.2, 0.3, 0.55))
    return (0.0, lasts, *first), (lasts + gap, lasts + gap + again, *second)


def _depth(chance: random.Random, code: Code) -> tuple[str, float]:
    if code.one_phase and chance.random() < 0.4:
        return "c", round(chance.uniform(0.2, 0.5), 2)
    high = 0.68 if code.settings else 0.82
    while True:
        level = round(chance.uniform(code.lowest_pu, high), 2)
        if not _CALM_PU[0] < level < _CALM_PU[1]:
            return "abc", level


_AMOUNTS: dict[What, tuple[float, ...]] = {
    What.CURRENT_TIMES: (0.0, 0.0, 0.02, 0.05, 0.2, 0.45, 0.7, 0.9, 1.1, 1.3, 1.7, -1.0),
    What.Q_TIMES: (0.0, 0.33, 0.6, 0.8, 1.2, 1.6, -1.0),
    What.Q_PLUS: (0.05, 0.1, 0.2, 0.4, -0.1, -0.3),
    What.P_TIMES: (0.0, 0.3, 0.6, 0.8, 1.2, -0.2),
    What.P_AT_MOST: (0.0, 0.1, 0.4, 0.7, 0.85),
    What.P_IS: (0.0, 0.1, -0.1, -0.25, 0.3),
    What.Q_SWINGS: (0.05, 0.1, 0.2, 0.4),
    What.P_SWINGS: (0.05, 0.1, 0.2, 0.4),
    What.TONE: (0.01, 0.03, 0.07, 0.2),
    What.HOLD: (0.0,),
    What.TURN: (-0.8, -0.3, 0.3, 0.8, 1.6),
    What.TRIP: (0.0,),
    What.DROPS: (0.0, 0.0, 0.3, 0.7),
    What.PHASE_A_TIMES: (0.0, 0.5, 0.8, 1.3),
    What.NEGATIVE_TIMES: (0.0, -1.0, 0.5, 2.0),
}
_RATES: dict[What, tuple[float, ...]] = {
    What.Q_SWINGS: (4.0, 8.0, 15.0, 30.0, 45.0),
    What.P_SWINGS: (4.0, 8.0, 15.0, 30.0, 45.0),
    What.TONE: (0.0, -50.0, -250.0, 350.0, 150.0, 80.0, 20.0),
    What.DROPS: (2.0, 4.0, 8.0, 20.0),
}


def _slip(chance: random.Random, levels: Sequence[tuple[float, float, str, float]]) -> Slip:
    what = chance.choice(list(_AMOUNTS))
    when = chance.choice((When.SAG, When.SAG, When.SAG, When.AFTER, When.AFTER, When.SAG | When.AFTER, When.ALWAYS))
    begins = (0.0, 0.0, 0.02, 0.05, 0.08, 0.12) if When.SAG in when else (0.0, 0.0, 0.05, 0.1, 0.2, 0.5, 0.9)
    begin_s = chance.choice(begins)
    lasts_s = chance.choice((1e3, 1e3, 1e3, 0.03, 0.05, 0.08, 0.15, 0.3, 0.6))
    at = {}
    if chance.random() < 0.2:  # at one level alone
        _, _, phases, level = chance.choice(levels)
        v_positive = level if phases == "abc" else (2 + level) / 3
        at = {"low_pu": round(v_positive - 0.03, 3), "high_pu": round(v_positive + 0.03, 3)}
    first, last = chance.choice(((0, 1000), (0, 1000), (0, 1), (1, 1), (2, 1000), (2, 1000)))
    amount, rate = chance.choice(_AMOUNTS[what]), chance.choice(_RATES.get(what, (0.0,)))
    return Slip(int(what), amount, rate, int(when), first, last, begin_s, begin_s + lasts_s, **at)


def outcome_of(trial: Trial, simulator: Simulator | None = None) -> Outcome:
    """Run one trial; ``simulator`` in place of the bundled controller with the trial's slip."""
    code, profile = CODES[trial.profile], profile_of(trial.profile)
    simulated = simulator or partial(simulate, run=wrong_run(slip=trial.slip), thin=False)
    test, parameters = test_of(trial, profile), parameters_from(code.settings if simulator is None else ())
    judged = run_test(profile, test, parameters, simulated)
    if judged.waveforms is None:
        return Outcome(judged.result, ())
    (segment,) = judged.waveforms.segments
    record = record_of(dict(segment.channels), segment.t_s, code.frequency_hz)
    levels = levels_of(trial, test, float(segment.t_s[-1]))
    return Outcome(judged.result, tuple(text for sentence in code.sentences for text in sentence(record, levels)))


def test_of(trial: Trial, profile: Profile) -> TestCase:
    """The test, as a sag of the user's own with further events."""
    (begin, end, phases, level), *further = trial.levels
    events = [_event(*one) for one in further]
    last_s = max(end_s for _, end_s, _, _ in trial.levels)
    test = profile.ad_hoc_test(
        Sag(depth=round(1 - level, 6), phases=phases),
        end - begin,
        events=events,
        after_s=round(last_s - end + trial.after_s, 6),
        point_on_wave_deg=trial.point_on_wave_deg,
    )
    return test.model_copy(update={"expect": "ride_through"}) if trial.as_row else test


def _event(begin_s: float, end_s: float, phases: str, level: float) -> dict[str, Any]:
    if level > 1:
        points = [(begin_s, 1.0), (begin_s, level), (end_s, level), (end_s, 1.0)]
        return {"kind": "voltage_profile", "points": points}
    sag = {"depth": round(1 - level, 6), "phases": phases}
    return {"kind": "sag", "t_s": begin_s, "duration_s": end_s - begin_s, "sag": sag}


def levels_of(trial: Trial, test: TestCase, record_end_s: float) -> list[Level]:
    """What the grid does from its first step on, with the normal voltage in between."""
    start_s = test.scenario.start_s
    steps = sorted({t for begin, end, _, _ in trial.levels for t in (begin, end)})
    found = []
    for begin, end in zip(steps, (*steps[1:], record_end_s - start_s), strict=True):
        here = [(phases, level) for since, until, phases, level in trial.levels if since <= begin < until]
        phases, level = here[-1] if here else ("abc", 1.0)
        positive, negative = (level, 0.0) if phases == "abc" else ((2 + level) / 3, (1 - level) / 3)
        found.append(Level(begin + start_s, end + start_s, positive, negative, min(level, 1.0)))
    return found


@cache
def profile_of(name: str) -> Profile:
    """A shipped profile, read once."""
    return load_profile(name)


def right_trial(name: str, grid: str) -> Trial:
    """The right controller in one of `GRIDS`, its levels such as the profile demands to be ridden through."""
    code = CODES[name]
    levels = tuple(
        one if one[2] == "c" and code.one_phase else (*one[:2], "abc", max(one[3], code.lowest_pu))
        for one in GRIDS[grid]
    )
    return Trial(name, levels, NO_SLIP, 0.0)
