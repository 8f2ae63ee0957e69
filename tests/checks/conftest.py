"""Records made by hand: voltages, currents and v_DC of a sag, each level chosen by the test."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from demands import CONTROL_STEP_S, MARK

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.data.marks import Number
from pvlvrt_compliance.profile import Profile, TestCase, load_profile
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.profile.requirements import BUILT_IN, Requirement, requirements_of
from pvlvrt_compliance.results import TestResult, Verdict
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.timeline import entries
from pvlvrt_compliance.space_vectors import fortescue, phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

STEP_S = 4 * CONTROL_STEP_S
"""122 samples of a cycle at 50 Hz: three and more of the 40th harmonic, at a quarter of the price."""


Level = float | Callable[[np.ndarray], np.ndarray]
"""A number, or a function of time."""


@dataclass
class Bench:
    """A record to be judged; by default a flawless inverter's through the sag of the test.

    Currents are balanced; the powers asked for come out as means at the terminals. Times count from the start of the
    sag, ``recovers_after_s`` and the arguments of ``p_after_kw`` and ``q_after_kvar`` from clearing. ``p_kw`` and
    ``q_kvar`` take the place of all other powers, ``flows`` is a factor on the current. ``negative_reactive_pu`` is
    added during the sag, positive where it lowers V-. ``healthy_pu`` scales the voltage outside of the sag. Events of
    the scenario move the voltages as they say; ``terminals_turn_rad`` is how far those at the terminals, with the
    currents, are ahead of the source's (rad).

    With ``later_s`` all of this is of a second sag, which begins that much after the test's own; ``later_duration_s``
    is its length. Through the test's own sag the inverter feeds ``first_q_kvar``, between the two P as before.
    """

    profile: Profile
    test: TestCase
    available_power_w: float = 500e3
    p_before_kw: float = 500.0
    q_before_kvar: float = 0.0
    p_sag_kw: Level = 10.0
    q_sag_kvar: Level = 0.0
    negative_reactive_pu: float = 0.0
    p_after_kw: Level = 500.0
    q_after_kvar: Level = 0.0
    recovers_after_s: float = 0.0
    sag: Sag | None = None
    no_load_sag: Sag | None = None
    healthy_pu: float = 1.0
    dc_ripple_percent: float = 0.0
    disconnected_after_s: float | None = None
    blocked_after_s: float | None = None
    extra_current_pu: Callable[[np.ndarray], np.ndarray] | None = None
    p_kw: Callable[[np.ndarray], np.ndarray] | None = None
    q_kvar: Callable[[np.ndarray], np.ndarray] | None = None
    flows: Callable[[np.ndarray], np.ndarray] | None = None
    terminals_turn_rad: Callable[[np.ndarray], np.ndarray] | None = None
    without: tuple[str, ...] = ()
    spoiled: dict[str, float] = field(default_factory=dict)
    nominal: Nominal = field(default_factory=Nominal)
    dt_s: float = STEP_S
    expect: str | None = "may_trip"
    later_s: float = 0.0
    later_duration_s: float | None = None
    first_q_kvar: float = 0.0

    @property
    def start_s(self) -> float:
        """Start of the sag that the record is about (s)."""
        return self.test.scenario.start_s + self.later_s

    @property
    def clear_s(self) -> float:
        """End of that sag (s)."""
        lasts = self.later_duration_s
        return self.test.scenario.clear_s if lasts is None else self.start_s + lasts

    def waveforms(self) -> Waveforms:
        """Sample the record."""
        scenario = self.test.scenario
        t = self.dt_s * np.arange(int(scenario.end_s / self.dt_s))
        in_sag = (t >= self.start_s) & (t < self.clear_s)
        in_first = (t >= scenario.start_s) & (t < scenario.clear_s)
        asked, turning = self._asked(t)
        u0, u = (
            asked if sag is None else self._voltage(sag, in_sag) for sag in (self.no_load_sag or self.sag, self.sag)
        )
        u = [np.where(in_sag | in_first, 1.0, self.healthy_pu) * x for x in u]
        i = self._current(t, u, in_sag)
        channels = {f"u0_{p}_v": (x * turning).real for p, x in zip("abc", u0, strict=True)}
        if self.terminals_turn_rad is not None:
            turning = turning * np.exp(1j * self.terminals_turn_rad(t - self.start_s))
        channels |= {f"u_{p}_v": (x * turning).real for p, x in zip("abc", u, strict=True)}
        feeding = self._feeding(t)
        channels |= {f"i_{p}_a": (x * turning).real * feeding for p, x in zip("abc", i, strict=True)}
        if self.extra_current_pu is not None:
            for p, x in zip("abc", self.extra_current_pu(t - self.later_s), strict=True):
                channels[f"i_{p}_a"] += x * self.nominal.phase_current_peak_a
        ripple = self.dc_ripple_percent / 100 * (turning**2).imag
        channels["v_dc_v"] = (900.0 + 20 * (t - self.start_s)) * (1 + in_sag * ripple)
        opened_s = np.inf if self.disconnected_after_s is None else self.start_s + self.disconnected_after_s
        channels["connected"] = (t < opened_s).astype(float)
        for name, at_s in self.spoiled.items():
            channels[name][np.searchsorted(t, at_s)] = np.nan
        return Waveforms((Segment(0.0, self.dt_s, {n: x for n, x in channels.items() if n not in self.without}),))

    def result(self) -> TestResult:
        """Judge the record."""
        return evaluate(self.profile, self.asked, self.waveforms(), self.nominal, self.available_power_w)

    @property
    def asked(self) -> TestCase:
        """The test; one that may end with nothing to judge, as a single requirement often has it."""
        return self.test if self.test.expect else self.test.model_copy(update={"expect": self.expect})

    def check(self, kind: str) -> Verdict:
        """Judge the record and pick one verdict."""
        return next(check for check in self.result().checks if check.check == kind)

    def _asked(self, t: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
        """Phasors of the source as asked for, and the turning of phase a's healthy fundamental."""
        table = entries(self.test.scenario)
        begin = np.array([entry.t_s for entry in table])
        here = np.searchsorted(begin, t, side="right") - 1
        dt = t - begin[here]
        angle, f, rate = (
            np.array([getattr(entry, name) for entry in table])[here]
            for name in ("angle_rad", "frequency_hz", "rocof_hz_s")
        )
        at, slope = (np.array([getattr(entry, n) for entry in table])[here].T for n in ("sequences_pu", "slope_pu_s"))
        phasors = phases(*(self.nominal.phase_voltage_peak_v * (at + slope * dt)))
        return list(phasors), np.exp(1j * (angle + 2 * np.pi * (f * dt + 0.5 * rate * dt**2)))

    def _voltage(self, sag: Sag, in_sag: np.ndarray) -> list[np.ndarray]:
        healthy = Sag(depth=0).phasors_pu()
        peak = self.nominal.phase_voltage_peak_v
        return [peak * np.where(in_sag, s, h) for s, h in zip(sag.phasors_pu(), healthy, strict=True)]

    def _current(self, t: np.ndarray, u: list[np.ndarray], in_sag: np.ndarray) -> list[np.ndarray]:
        """Balanced positive-sequence phasors that carry the powers asked for: i = (2/3) conj(S / u+) a phase."""
        positive, negative, _ = fortescue(*u)
        p, q = self._powers(t, in_sag)
        dead = np.abs(positive) < 1e-6
        current = np.where(dead, 0, 2 / 3 * np.conj(1e3 * (p + 1j * q) / np.where(dead, 1, positive)))
        balanced = np.abs(negative) < 1e-6
        along = np.where(balanced, 0, negative / np.where(balanced, 1, np.abs(negative)))
        support = in_sag * self.negative_reactive_pu * self.nominal.phase_current_peak_a
        return list(phases(current, 1j * support * along, 0))

    def _powers(self, t: np.ndarray, in_sag: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        scenario = self.test.scenario
        since_clearing = t - self.clear_s
        p = np.where(t < self.start_s, self.p_before_kw, at(self.p_after_kw, since_clearing))
        p = np.where(in_sag, at(self.p_sag_kw, t - self.start_s), p)
        p = np.where((since_clearing >= 0) & (since_clearing < self.recovers_after_s), 10.0, p)
        q = np.where(t < self.start_s, self.q_before_kvar, at(self.q_after_kvar, since_clearing))
        q = np.where(in_sag, at(self.q_sag_kvar, t - self.start_s), q)
        p = p if self.p_kw is None else self.p_kw(t - self.start_s)
        q = q if self.q_kvar is None else self.q_kvar(t - self.start_s)
        if not self.later_s:
            return p, q
        in_first = (t >= scenario.start_s) & (t < scenario.clear_s)
        return np.where(in_first, 0.0, p), np.where(in_first, self.first_q_kvar, q)

    def _feeding(self, t: np.ndarray) -> np.ndarray:
        stops = [s for s in (self.disconnected_after_s, self.blocked_after_s) if s is not None]
        since_start = t - self.start_s
        factor = 1.0 if self.flows is None else self.flows(since_start)
        return factor * (since_start < min(stops, default=np.inf))


def at(level: Level, t: np.ndarray) -> np.ndarray:
    """Values of a level at some instants."""
    return np.asarray(level(t) if callable(level) else level)


def chosen(value: Any, name: str = "value") -> dict[str, Any]:
    """A number, or whatever stands under ``name``, with a mark."""
    return {name: value} | MARK


def marked(kind: str, **numbers: Any) -> Requirement:
    """A requirement of a kind; numbers and words get a mark, tables and models are taken as they are."""
    model = BUILT_IN[kind]
    plain = {name: x if isinstance(x, dict) else chosen(x) for name, x in numbers.items()}
    return model.model_validate({"clause": "a clause", "source": "the test"} | plain)


@pytest.fixture
def demanding(iec: Profile) -> Callable[..., Profile]:
    """Make a profile that demands these kinds only, each given by its numbers.

    ``detection`` gives the numbers of the thresholds, ``tolerance_pu`` how far the sag may miss what was asked for.
    """

    def make(detection: dict[str, float] | None = None, tolerance_pu: float = 0.05, **kinds: dict[str, Any]) -> Profile:
        requirements = requirements_of(BUILT_IN)(**{kind: marked(kind, **numbers) for kind, numbers in kinds.items()})
        conditions = iec.conditions.model_copy(update={"no_load_tolerance_pu": Number(**chosen(tolerance_pu))})
        thresholds = detection and Detection(**{name: Number(**chosen(x)) for name, x in detection.items()})
        return iec.model_copy(update={"requirements": requirements, "conditions": conditions, "detection": thresholds})

    return make


@pytest.fixture(scope="session")
def iec() -> Profile:
    """The shipped profile with an envelope."""
    return load_profile("iec61400-21")


@pytest.fixture(scope="session")
def spain() -> Profile:
    """The shipped profile without an envelope."""
    return load_profile("spain-q-curve")


@pytest.fixture
def bench(iec: Profile) -> Callable[..., Bench]:
    """Make a record of a sag of all phases (``depth``) that a profile judges; further arguments are `Bench`'s."""

    def make(depth: float = 0.5, duration_s: float | None = 0.3, profile: Profile = iec, **settings: Any) -> Bench:
        scenario = settings.pop("scenario", {})
        sag = settings.pop("asked", None) or Sag(depth=depth)
        return Bench(profile, profile.ad_hoc_test(sag, duration_s, **scenario), **settings)

    return make


def _marked(item: Any) -> Any:
    """Numbers of a requirement with a mark each; tables carry their own."""
    if isinstance(item, dict):
        return item if "confidence" in item else {key: _marked(part) for key, part in item.items()}
    return item if isinstance(item, str) else chosen(item)


@pytest.fixture
def profile_with(spain: Profile) -> Callable[[str, dict[str, Any]], Profile]:
    """Make a profile of one requirement alone; plain numbers get a mark."""

    def make(kind: str, requirement: dict[str, Any]) -> Profile:
        whole = spain.model_dump(by_alias=True) | {"requirements": {kind: _marked(requirement)}, "tests": ()}
        return type(spain).model_validate(whole)

    return make
