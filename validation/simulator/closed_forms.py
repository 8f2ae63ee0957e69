"""Random unbalanced sags against the closed form of what the paper's control then asks for and delivers."""

import math
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.measure.fourier import mean
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.space_vectors import fortescue
from validation.simulator.evidence import Plot, Row, Section, at_most
from validation.simulator.records import NOMINAL, in_parallel, record, residual_sag, vector

SAGS = 200
TOLERANCE_PERCENT = 2.0
_SEED = 20180301
_ANGLE_MAX = math.radians(30)
_HEALTHY = np.exp(-2j * np.pi / 3 * np.arange(3))


class Delivered(NamedTuple):
    """What the control believes and delivers during a sag."""

    v_fault: float  # V_fault (pu)
    p_ref: float  # P* (pu)
    p: float  # mean P at the PCC (pu)
    q: float  # mean Q at the PCC (pu)


def closed_form(positive: float, negative: float) -> Delivered:
    """What eqs (5) and (7) to (10) come to for V+ and V- (pu), on a stiff grid and with enough sun.

    Eq (5) divides the reactive part by the active part's denominator, so under unbalance the mean Q exceeds Q*.
    """
    s_fault = positive - negative
    q = min(15 / 7 * (0.85 - positive), 0.75, s_fault)
    p = math.sqrt(s_fault**2 - q**2)
    more = (positive**2 + negative**2) / (positive**2 - negative**2)
    return Delivered(v_fault=positive, p_ref=p, p=p, q=q * more)


def sequences(residuals: tuple[complex, complex, complex]) -> tuple[float, float]:
    """V+ and V- (pu) of three residual phasors."""
    positive, negative, _ = fortescue(*residuals)
    return abs(positive), abs(negative)


def is_asked_for(residuals: tuple[complex, complex, complex]) -> bool:
    """Whether a sag is deep enough for the detector and far enough from 0/0 in eq (5)."""
    positive, negative = sequences(residuals)
    return positive <= 0.84 and positive - negative >= 0.05


def random_sags(count: int) -> list[tuple[complex, complex, complex]]:
    """Residual phasors (pu): magnitudes 0 to 1, angles within 30 degrees of the healthy ones."""
    rng = np.random.default_rng(_SEED)
    found: list[tuple[complex, complex, complex]] = []
    while len(found) < count:
        angles = rng.uniform(-_ANGLE_MAX, _ANGLE_MAX, 3)
        a, b, c = (complex(x) for x in rng.uniform(0, 1, 3) * np.exp(1j * angles) * _HEALTHY)
        if is_asked_for((a, b, c)):
            found.append((a, b, c))
    return found


def delivered(residuals: tuple[complex, complex, complex]) -> Delivered:
    """Simulate a sag of 0.6 s and average from 0.1 s after its start to 0.02 s before its end."""
    scenario = Scenario(sag=residual_sag(*residuals), duration_s=0.6, before_s=0.25, after_s=0.1)
    during = record(scenario).slice(scenario.start_s + 0.1, scenario.clear_s - 0.02)
    s = vector(during, "u") * vector(during, "i").conj() / NOMINAL.apparent_power_va
    means = [
        mean(x, during.dt_s, 50.0)
        for x in (during["v_fault_pu"], during["p_ref_w"] / NOMINAL.apparent_power_va, s.real, s.imag)
    ]
    return Delivered(*means)


class Comparison(NamedTuple):
    """Arrays of shape (sags, 4): the fields of `Delivered`."""

    found: np.ndarray[Any, Any]
    expected: np.ndarray[Any, Any]

    @property
    def worst_percent(self) -> Delivered:
        """Largest differences (percent of nominal)."""
        return Delivered(*(float(x) for x in 100 * np.abs(self.found - self.expected).max(axis=0)))


def compare(count: int = SAGS) -> Comparison:
    """Simulate random sags beside their closed form."""
    sags = random_sags(count)
    found = in_parallel(delivered, sags)
    return Comparison(np.array(found), np.array([closed_form(*sequences(sag)) for sag in sags]))


def rows(comparison: Comparison) -> tuple[Row, ...]:
    """Largest differences of the four quantities."""
    names = ("V_fault", "P*", "mean P at the PCC", "mean Q at the PCC")
    worst = zip(names, comparison.worst_percent, strict=True)
    return tuple(at_most(f"{name}, largest of {SAGS}", x, TOLERANCE_PERCENT, "% of nominal", 0.01) for name, x in worst)


def drawing(c: Comparison) -> Plot:
    """Found over expected."""

    def draw(figure: Any) -> None:
        for axes, k, name in zip(figure.subplots(1, 2), (1, 3), ("P*", "mean Q at the PCC"), strict=True):
            axes.plot([0, 0.8], [0, 0.8], "k:", linewidth=0.8)
            axes.plot(c.expected[:, k], c.found[:, k], ".", markersize=4)
            axes.set(xlabel=f"{name}, closed form (pu)", ylabel="simulated (pu)")

    return Plot("closed-forms", "Each point is a sag.", draw)


def section() -> Section:
    """Section on closed forms."""
    c = compare()
    return Section("Random sags against the closed form", _TEXT, rows(c), (drawing(c),))


_TEXT = """200 random sags of 0.6 s on a stiff grid: three residual voltages between 0 and 1 pu, each within 30
degrees of its healthy angle, kept when V+ is at most 0.84 and V+ - V- at least 0.05. The symmetrical components of
the three phasors (Fortescue) give V_fault, S_fault, Q* and P* by eqs (7) to (10), and what eq (5) then delivers: P
= P* and a mean Q = Q* (V+^2 + V-^2) / (V+^2 - V-^2), because eq (5) divides the reactive part by the active part's
denominator. Means from 0.1 s after the start to 0.02 s before the end; relays are set out of the way."""
