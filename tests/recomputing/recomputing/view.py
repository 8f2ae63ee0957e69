"""What is known of one test: its record, its windows and the series made from it."""

from functools import cached_property
from typing import Any

import numpy as np

from recomputing.cycles import (
    mean_of_cycle,
    phasors,
    sequences,
    steady_frequency,
    steering_frequency,
    tracked_frequency,
)
from recomputing.grid import Grid, Stretch
from recomputing.numbers import Missing, Off, Table, finite, number
from recomputing.samples import SAME_S, even
from recomputing.standard import THRESHOLDS, WINDOWS


class View:
    """One test: what the result says of the grid, the profile, and the record on one even grid of samples."""

    def __init__(self, result: Table, profile: Table, waveforms: dict[str, np.ndarray]) -> None:
        self.result, self.profile, self.grid = result, profile, Grid(result["disturbance"])
        rating = result["rating"]
        self.rated_kva: float = rating["apparent_power_kva"]
        self.nominal_hz: float = rating["frequency_hz"]
        self.base_v = np.sqrt(2) * rating["phase_voltage_v"]
        self.base_a = np.sqrt(2) * 1e3 * self.rated_kva / (3 * rating["phase_voltage_v"])
        self.expect = result.get("expect")
        self.known_voltages: dict[tuple[float, float], tuple[float, float]] = {}
        self._sequences: dict[str, np.ndarray] = {}
        self.of = even(waveforms)
        self.t_s = self.of["t_s"]
        self.dt_s = float((self.t_s[-1] - self.t_s[0]) / (len(self.t_s) - 1))
        self.last_s = float(self.t_s[-1])
        self.step_at_end_s = float(waveforms["t_s"][-1] - waveforms["t_s"][-2])
        self.end_s = self.last_s + self.step_at_end_s

    def demand(self, kind: str) -> Table | None:
        """What the profile demands of a kind."""
        found: Table | None = self.profile["requirements"].get(kind)
        return found

    def threshold(self, name: str) -> float:
        """A threshold of the profile, or the standard one."""
        return float(number(self.profile.get("thresholds"), name, THRESHOLDS[name]))

    def rule(self, name: str) -> float:
        """Where the windows lie."""
        return float(number(self.profile.get("windows"), name, WINDOWS[name]))

    @property
    def blocked_pu(self) -> float:
        """Current below which a phase carries none."""
        return float(number(self.profile["conditions"], "blocked_below_pu"))

    @cached_property
    def opened_s(self) -> float | None:
        """First sample with the breaker open."""
        if "connected" not in self.of:
            return None
        open_at = np.flatnonzero(finite(self.of["connected"], "the breaker") < 0.5)
        return float(self.t_s[open_at[0]]) if len(open_at) else None

    # --- samples

    def between(self, begin_s: float, end_s: float) -> np.ndarray:
        """Mask of the samples from one instant to another, both included."""
        return (self.t_s >= begin_s - SAME_S) & (self.t_s <= end_s + SAME_S)

    def up_to(self, begin_s: float, end_s: float) -> np.ndarray:
        """Mask of the samples from one instant to before another."""
        return (self.t_s >= begin_s - SAME_S) & (self.t_s < end_s - SAME_S)

    def abc(self, kind: str) -> np.ndarray:
        """Three phases of u, u0 (V) or i (A)."""
        unit = "a" if kind == "i" else "v"
        names = [f"{kind}_{phase}_{unit}" for phase in "abc"]
        if any(name not in self.of for name in names):
            raise Missing(f"the record has no {kind}")
        return np.stack([self.of[name] for name in names])

    @property
    def source(self) -> str:
        """Voltages without the inverter's current where the record has them."""
        return "u0" if "u0_a_v" in self.of else "u"

    # --- frequency

    @cached_property
    def hz(self) -> float:
        """Frequency before the disturbance."""
        here = self.up_to(self.grid.start_s - 0.5, self.grid.start_s)
        floor = self.threshold("voltage_floor_pu") * self.base_v
        return steady_frequency(self.abc("u")[:, here], self.dt_s, self.nominal_hz, floor) or self.nominal_hz

    @cached_property
    def tracked_hz(self) -> np.ndarray:
        """Frequency of the source at each sample."""
        return self._tracked(self.source)

    def _tracked(self, kind: str) -> np.ndarray:
        floor = self.threshold("voltage_floor_pu") * self.base_v
        return tracked_frequency(self.abc(kind), self.dt_s, self.nominal_hz, floor)

    @cached_property
    def window_hz(self) -> float | np.ndarray:
        """Frequency that one-cycle windows go by."""
        if not self.grid.frequency_moves:
            return self.hz
        return steering_frequency(self._tracked("u"), self.dt_s, self.nominal_hz)

    @property
    def cycle_s(self) -> float:
        """One cycle of the frequency before."""
        return 1 / self.hz

    # --- series of one cycle

    def _one_cycle(self, kind: str) -> np.ndarray:
        known = self.__dict__.setdefault("_phasors", {})
        if kind not in known:
            known[kind] = phasors(self.abc(kind), self.window_hz, self.dt_s)
        found: np.ndarray = known[kind]
        return found

    def voltages_pu(self, kind: str) -> np.ndarray:
        """Phasors of the phases, shape (3, n)."""
        return self._one_cycle(kind) / self.base_v

    def amplitude_pu(self, kind: str, index: int) -> np.ndarray:
        """Amplitude of V+ (0), V- (1) or V0 (2)."""
        return np.abs(self._of_sequences(kind)[index]) / self.base_v

    def _of_sequences(self, kind: str) -> np.ndarray:
        if kind not in self._sequences:
            self._sequences[kind] = sequences(self._one_cycle(kind))
        return self._sequences[kind]

    @cached_property
    def v_plus(self) -> np.ndarray:
        """V+ at the terminals."""
        return self.amplitude_pu("u", 0)

    @cached_property
    def v_minus(self) -> np.ndarray:
        """V- at the terminals."""
        return self.amplitude_pu("u", 1)

    @cached_property
    def current_phase_pu(self) -> np.ndarray:
        """Amplitude of each phase current."""
        return np.abs(self._one_cycle("i")) / self.base_a

    @cached_property
    def current_pu(self) -> np.ndarray:
        """Instantaneous phase currents."""
        return self.abc("i") / self.base_a

    def sequence_current(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """Active and reactive current of a sequence; reactive is positive where it supports."""
        u, i = self._of_sequences("u")[index], self._of_sequences("i")[index]
        with np.errstate(invalid="ignore", divide="ignore"):
            found = u * np.conj(i) / np.abs(u) / self.base_a
            found[~(np.abs(u) >= self.threshold("voltage_floor_pu") * self.base_v)] = np.nan
        return found.real, found.imag if index == 0 else -found.imag

    def reactive(self, index: int) -> np.ndarray:
        """Reactive current of a sequence, 0 without its voltage."""
        faint = self.amplitude_pu("u", index) < self.threshold("voltage_floor_pu")
        return np.where(faint, 0.0, self.sequence_current(index)[1])

    @cached_property
    def powers(self) -> np.ndarray:
        """Instantaneous P (kW) and Q (kvar) to the grid."""
        u, i = self.abc("u"), self.abc("i")
        p = (u * i).sum(axis=0) - u.sum(axis=0) * i.sum(axis=0) / 3
        q = ((u[1] - u[2]) * i[0] + (u[2] - u[0]) * i[1] + (u[0] - u[1]) * i[2]) / np.sqrt(3)
        return np.stack([p, q]) / 1e3

    @cached_property
    def mean_powers(self) -> np.ndarray:
        """Means of P and Q over a cycle."""
        return mean_of_cycle(self.powers, 1 / (np.asarray(self.window_hz) * self.dt_s))

    @cached_property
    def half_cycle_powers(self) -> np.ndarray:
        """Means of P and Q over half a cycle."""
        return mean_of_cycle(self.powers, 0.5 / (np.asarray(self.window_hz) * self.dt_s))

    # --- windows

    def whole(self, begin_s: float, end_s: float) -> tuple[float, float] | None:
        """The last whole cycles of a stretch of time."""
        cycles = int(np.floor((end_s - begin_s) * self.hz + 1e-3))
        return (end_s - cycles / self.hz, end_s) if cycles >= 1 else None

    @cached_property
    def before(self) -> tuple[float, float]:
        """The window before the disturbance."""
        begin_s = self.grid.start_s - self.rule("before_start_s")
        found = self.whole(begin_s, self.grid.start_s - self.rule("before_end_s"))
        if found is None or begin_s < self.t_s[0] - 1e-3:
            raise Missing("there is no window before")
        return found

    @cached_property
    def after(self) -> tuple[float, float] | None:
        """The window at the end of the record."""
        if self.end_s - self.grid.clear_s < self.rule("after_clearing_s") - 1e-3:
            return None
        return self.whole(self.end_s - self.rule("after_length_s"), self.end_s)

    def during(self, begin_s: float, end_s: float) -> tuple[float, float] | None:
        """The window during a sag."""
        return self.whole(begin_s + self.rule("during_start_s"), min(end_s - self.rule("during_end_s"), self.last_s))

    def settled(self, part: Stretch, despite: tuple[str, ...] = ()) -> tuple[float, float]:
        """The settled window of a stretch."""
        if any(what not in despite for what in part["ramps"]):
            raise Off("something moves")
        begin_s, end_s = part["begin_s"] + self.rule("during_start_s"), part["end_s"]
        found = self.whole(begin_s, end_s - self.rule("during_end_s")) or self.whole(begin_s, end_s)
        if found is None:
            raise Off("too short for a whole cycle")
        return found

    # --- stretches

    @cached_property
    def released_s(self) -> float | None:
        """When the limits of the voltage let the inverter go."""
        from recomputing.limits import released_s

        return released_s(self)

    def until(self, what: str) -> float:
        """The trip, or the release if that comes first, or the end of the record."""
        ends = [self.end_s, self.opened_s, self.released_s if what == "release" else None]
        return min(t for t in ends if t is not None)

    def stretches(self, until: str) -> list[Stretch]:
        """All stretches up to trip or release."""
        end_s = self.until(until)
        if end_s <= self.grid.start_s:
            raise Off("nothing is left to judge")
        return self.grid.following(end_s)

    def disturbed(self, until: str) -> list[Stretch]:
        """Those before the voltage has come to where it stays."""
        last_s = self.grid.end_s if self.grid.steps_of("voltage") else self.end_s
        return [part for part in self.stretches(until) if part["begin_s"] < last_s]

    def is_event(self, v_plus: Any) -> Any:
        """Whether a V+ is a sag or a swell by the profile's thresholds."""
        found = self.profile.get("detection")
        if found is None:
            return np.ones(np.shape(v_plus), dtype=bool)
        low = np.asarray(v_plus) < number(found, "enter_below_pu")
        high = number(found, "enter_above_pu")
        return low if high is None else low | (np.asarray(v_plus) > high)
