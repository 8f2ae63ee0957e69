"""Records made by hand: voltages, currents and v_DC of a sag, each level chosen by the test."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.checks.results import Check, TestResult
from pvlvrt_compliance.profile import Profile, TestCase, load_profile
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.timeline import entries
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

DT_S = 40.9568e-6


@dataclass
class Bench:
    """A record to be judged; by default a flawless inverter's through the sag of the test.

    Currents are balanced; the powers asked for come out as means at the terminals. Times count from the start of the
    sag, ``recovers_after_s`` and the argument of ``p_after_kw`` from clearing. ``p_kw`` and ``q_kvar`` take the place
    of all other powers, ``flows`` is a factor on the current. Events of the scenario move the voltages as they say.
    """

    profile: Profile
    test: TestCase
    available_power_w: float = 500e3
    p_before_kw: float = 500.0
    p_sag_kw: float = 0.0
    q_sag_kvar: float = 0.0
    p_after_kw: float | Callable[[np.ndarray], np.ndarray] = 500.0
    recovers_after_s: float = 0.0
    sag: Sag | None = None
    no_load_sag: Sag | None = None
    dc_ripple_percent: float = 0.0
    disconnected_after_s: float | None = None
    blocked_after_s: float | None = None
    extra_current_pu: Callable[[np.ndarray], np.ndarray] | None = None
    p_kw: Callable[[np.ndarray], np.ndarray] | None = None
    q_kvar: Callable[[np.ndarray], np.ndarray] | None = None
    flows: Callable[[np.ndarray], np.ndarray] | None = None
    without: tuple[str, ...] = ()
    spoiled: dict[str, float] = field(default_factory=dict)
    nominal: Nominal = field(default_factory=Nominal)

    def waveforms(self) -> Waveforms:
        """Sample the record at the control step."""
        scenario = self.test.scenario
        t = DT_S * np.arange(int(scenario.end_s / DT_S))
        in_sag = (t >= scenario.start_s) & (t < scenario.clear_s)
        asked, turning = self._asked(t)
        u0, u = (
            asked if sag is None else self._voltage(sag, in_sag) for sag in (self.no_load_sag or self.sag, self.sag)
        )
        i = self._current(t, u, in_sag)
        channels = {f"u_{p}_v": (x * turning).real for p, x in zip("abc", u, strict=True)}
        channels |= {f"u0_{p}_v": (x * turning).real for p, x in zip("abc", u0, strict=True)}
        feeding = self._feeding(t)
        channels |= {f"i_{p}_a": (x * turning).real * feeding for p, x in zip("abc", i, strict=True)}
        if self.extra_current_pu is not None:
            for p, x in zip("abc", self.extra_current_pu(t), strict=True):
                channels[f"i_{p}_a"] += x * self.nominal.phase_current_peak_a
        ripple = self.dc_ripple_percent / 100 * (turning**2).imag
        channels["v_dc_v"] = (900.0 + 20 * (t - scenario.start_s)) * (1 + in_sag * ripple)
        opened_s = np.inf if self.disconnected_after_s is None else scenario.start_s + self.disconnected_after_s
        channels["connected"] = (t < opened_s).astype(float)
        for name, at_s in self.spoiled.items():
            channels[name][np.searchsorted(t, at_s)] = np.nan
        return Waveforms((Segment(0.0, DT_S, {n: x for n, x in channels.items() if n not in self.without}),))

    def result(self) -> TestResult:
        """Judge the record."""
        return evaluate(self.profile, self.test, self.waveforms(), self.nominal, self.available_power_w)

    def check(self, kind: str) -> Check:
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
        scenario = self.test.scenario
        rotation = np.exp(2j * np.pi / 3)
        positive = (u[0] + rotation * u[1] + rotation.conjugate() * u[2]) / 3
        after = self.p_after_kw(t - scenario.clear_s) if callable(self.p_after_kw) else self.p_after_kw
        p = np.where(t < scenario.start_s, self.p_before_kw, after)
        p = np.where(in_sag, self.p_sag_kw, p)
        p = np.where((t >= scenario.clear_s) & (t < scenario.clear_s + self.recovers_after_s), 0.0, p)
        q = np.where(in_sag, self.q_sag_kvar, 0.0)
        since_start = t - scenario.start_s
        p = p if self.p_kw is None else self.p_kw(since_start)
        q = q if self.q_kvar is None else self.q_kvar(since_start)
        power = 1e3 * (p + 1j * q)
        dead = np.abs(positive) < 1e-6
        current = np.where(dead, 0, 2 / 3 * np.conj(power / np.where(dead, 1, positive)))
        return [current, current * rotation.conjugate(), current * rotation]

    def _feeding(self, t: np.ndarray) -> np.ndarray:
        stops = [s for s in (self.disconnected_after_s, self.blocked_after_s) if s is not None]
        since_start = t - self.test.scenario.start_s
        factor = 1.0 if self.flows is None else self.flows(since_start)
        return factor * (since_start < min(stops, default=np.inf))


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
    return item if isinstance(item, str) else {"value": item, "confidence": "chosen", "source": "a test"}


@pytest.fixture
def profile_with(spain: Profile) -> Callable[[str, dict[str, Any]], Profile]:
    """Make a profile of one requirement alone; plain numbers get a mark."""

    def make(kind: str, requirement: dict[str, Any]) -> Profile:
        whole = spain.model_dump(by_alias=True) | {"requirements": {kind: _marked(requirement)}, "tests": ()}
        return Profile.model_validate(whole)

    return make
