"""A limit of a requirement as two records: one just inside, one just outside."""

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

RATED_KVA = 500.0
"""Rating of the bench's inverter."""

SHORT_STEP_S = 8 * 40.9568e-6
"""Eight control steps: 61 samples of a cycle at 50 Hz, 51 at 60 Hz."""

STEP_S = 0.7e-3
"""Distance in time: two samples."""

Statuses = frozenset[Status]

PASS, FAIL = frozenset({Status.PASS}), frozenset({Status.FAIL})
LET_OFF = frozenset({Status.NOT_APPLICABLE})
FREE = frozenset({Status.NOT_APPLICABLE, Status.PASS})
"""An inverter that may let go, or had to cease and did."""

LEVEL_PU = 1e-3
"""Distance in voltage."""

CURRENT_PU = 1e-3
"""Distance in current, as a fraction of nominal."""

SHARE = 2e-3
"""Distance as a fraction of the limit."""

FINE_STEP_S = 2 * 40.9568e-6
"""122 samples of a cycle at 50 Hz: two and more of the 50th harmonic."""

LONG_S = 100.0
"""Records that last longer are sampled eight times a cycle."""

NO_SAG = Sag(depth=0)


class Record(NamedTuple):
    """One record, and the verdicts that it may get."""

    statuses: Statuses
    asked: Sag
    duration_s: float
    scenario: dict[str, Any]
    settings: dict[str, Any]  # of `Bench`


class Edge(NamedTuple):
    """One side of one limit.

    ``only`` replaces fields of the requirement, so that a limit can be reached alone: by another number, a part, or
    nothing. ``alone`` leaves the profile's other requirements out where checks look at them.
    """

    label: str
    numbers: tuple[str, ...]  # names of the marked numbers that the edge depends on
    inside: Record
    outside: Record
    only: Mapping[str, Any] = MappingProxyType({})
    alone: bool = False
    further: Record | None = None  # another one just outside, in another direction


FIRST = Sag(depth=0.5)
"""A sag that comes before the one of an edge, and what is right in it: nominal reactive current and nothing else."""

FIRST_S, LATER_S = 0.3, 0.6
"""Its length, and when the other one begins (s)."""


def in_a_second_stretch(made: Record, profile: Profile) -> Record:
    """The same record after a first sag that nothing is wrong in; who was let off has then passed."""
    after_s = made.scenario.get("after_s", profile.procedure.after_s.value)
    second = {"kind": "sag", "t_s": LATER_S, "duration_s": made.duration_s, "sag": made.asked.model_dump()}
    events = [second, *(_later(event) for event in made.scenario.get("events", ()))]
    scenario = made.scenario | {"events": events, "after_s": LATER_S + made.duration_s - FIRST_S + after_s}
    settings = {"later_s": LATER_S, "later_duration_s": made.duration_s, "first_q_kvar": RATED_KVA * (1 - FIRST.depth)}
    statuses = made.statuses | PASS if made.statuses == LET_OFF else made.statuses
    return Record(statuses, FIRST, FIRST_S, scenario, made.settings | settings)


def _later(event: dict[str, Any]) -> dict[str, Any]:
    """An event of a voltage, after the first sag."""
    return event | {"points": [(t + LATER_S, u) for t, u in event["points"]]}


Generator = Callable[[Any, Profile], Iterator[Edge]]
"""Makes the edges of a requirement (of its own class) in its profile."""


def record(
    statuses: Statuses,
    asked: Sag = NO_SAG,
    duration_s: float = 0.3,
    scenario: dict[str, Any] | None = None,
    **settings: Any,
) -> Record:
    """A record of a sag, or of none, with the settings of the bench."""
    return Record(statuses, asked, duration_s, scenario or {}, settings)


def hz(profile: Profile) -> float:
    """Nominal frequency (Hz)."""
    return profile.procedure.frequency_hz.value if profile.procedure.frequency_hz else 50.0


def held(u_pu: float, duration_s: float, t_s: float = 0.0) -> dict[str, Any]:
    """Event: the voltage of all phases at a level for a time."""
    points = [(t_s, 1.0), (t_s, u_pu), (t_s + duration_s, u_pu), (t_s + duration_s, 1.0)]
    return {"kind": "voltage_profile", "points": points}


def two_phase(v_negative_pu: float) -> Sag:
    """Isolated two-phase sag with a V- (pu); V+ is 1 pu less that."""
    return Sag(depth=2 * v_negative_pu, phases="bc", two_phase=True)


def kvar(current_pu: float, v_positive_pu: float) -> float:
    """Reactive power of a current at a positive-sequence voltage (kvar)."""
    return RATED_KVA * current_pu * v_positive_pu


def until(t_s: float, before: float, after: float) -> Callable[[np.ndarray], np.ndarray]:
    """A level that changes at an instant."""
    return lambda t: np.where(t < t_s, before, after)


def between(from_s: float, to_s: float, level: float) -> Callable[[np.ndarray], np.ndarray]:
    """A level between two instants, zero else."""
    return lambda t: np.where((t >= from_s) & (t < to_s), level, 0.0)
