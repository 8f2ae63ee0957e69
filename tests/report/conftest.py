"""Records and results made from closed forms, for every format to show."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import STANDARD_RULES
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.of_test import drawing
from pvlvrt_compliance.results import Band, ProfileSummary, Results, Status, TestResult, Verdict, conclude
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.space_vectors import fortescue, phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

DT_S = 40.9568e-6
ENVELOPE = ((0.0, 0.0), (0.15, 0.0), (1.5, 0.85))
NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)


def _synthetic_record(scenario: Scenario, nominal: Nominal, opens_s: float | None = None) -> Waveforms:
    """Voltages of the sag exactly, nominal current in phase with V+, a decaying peak at the start, a DC rise."""
    t = np.arange(round(scenario.end_s / DT_S)) * DT_S
    w = 2 * np.pi * scenario.frequency_hz
    turn = np.exp(1j * (w * (t - scenario.start_s) + np.radians(scenario.point_on_wave_deg)))
    during = (t >= scenario.start_s) & (t < scenario.clear_s)
    since = np.clip(t - scenario.start_s, 0, None)
    healthy = Sag(depth=0).phasors_pu()
    sagged = scenario.sag.phasors_pu()
    positive = np.where(during, fortescue(*sagged)[0], 1)
    peak = np.where(during, 0.6 * np.exp(-since / 0.006), 0)
    closed = t < (np.inf if opens_s is None else opens_s)
    lag = np.where(during, np.exp(-0.4j * np.pi), 1)
    current = nominal.phase_current_peak_a * (0.98 + peak) * lag * positive / np.abs(positive) * turn * closed
    u = [
        nominal.phase_voltage_peak_v * (np.where(during, s, h) * turn).real
        for s, h in zip(sagged, healthy, strict=True)
    ]
    i = [x.real for x in phases(current, 0 * current, 0 * current)]
    v_dc = 834 + 169 * np.where(
        during, 1 - np.exp(-since / 0.06), np.exp(-np.clip(t - scenario.clear_s, 0, None) / 0.03)
    )
    v_dc = np.where(t < scenario.start_s, 834, v_dc) + 1.5 * np.where(during, np.cos(2 * w * t), 0)
    channels = dict(zip(["u_a_v", "u_b_v", "u_c_v"], u, strict=True)) | dict(
        zip(["i_a_a", "i_b_a", "i_c_a"], i, strict=True)
    )
    return Waveforms((Segment(0.0, DT_S, channels | {"v_dc_v": v_dc, "connected": closed.astype(float)}),))


@pytest.fixture(scope="session")
def nominal() -> Nominal:
    """The paper's inverter."""
    return Nominal()


@pytest.fixture(scope="session")
def scenario() -> Scenario:
    """Phase c, 90 %."""
    return Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=0.309)


@pytest.fixture(scope="session")
def make_record(nominal: Nominal) -> Callable[..., Waveforms]:
    """Make a record of a scenario: ``make_record(scenario, opens_s=None)``."""
    return lambda scenario, opens_s=None: _synthetic_record(scenario, nominal, opens_s)


@pytest.fixture(scope="session")
def record(scenario: Scenario, make_record: Callable[..., Waveforms]) -> Waveforms:
    """The record of that scenario."""
    return make_record(scenario)


def _checks(reactive: Status) -> tuple[Verdict, ...]:
    margin = 75.0 if reactive is Status.PASS else -4.2
    short = "mean reactive power 156.5 kvar is 4.2 kvar below the curve at 0.700 pu"
    rows: tuple[dict[str, Any], ...] = (
        {"check": "ride_through", "measured": 0.027, "limit": 1.0, "margin": 0.973, "unit": "s", "at_s": 0.636}
        | {"clause": "Fig. 4(a)", "confidence": "inferred", "message": "connected; P back to 95 % after 0.027 s"},
        {"check": "current_limit", "measured": 0.9997, "limit": 1.02, "margin": 0.0203, "unit": "pu", "at_s": 0.371}
        | {"clause": "eq (8)", "confidence": "chosen"},
        {"check": "reactive_support", "measured": 160.7 + margin, "limit": 160.7, "margin": margin, "unit": "kvar"}
        | {"clause": "eq (9)", "confidence": "confirmed", "message": "" if reactive is Status.PASS else short},
        {"check": "dc_ripple", "unit": "%", "clause": "section 4 <3>", "confidence": "chosen"}
        | {"message": "the window during the sag is shorter than one cycle [& a half]"},
    )
    statuses = (Status.PASS, Status.PASS, reactive, Status.NOT_APPLICABLE)
    return tuple(Verdict(status=status, **row) for status, row in zip(statuses, rows, strict=True))


def _bands(scenario: Scenario, measurements: MeasuredWindows) -> tuple[Band, ...]:
    """The envelope from the start on, both limits of the current, and what is demanded of Q in the window."""
    whole, during = (0.0, scenario.end_s), measurements.during
    t, level = zip(*ENVELOPE, (scenario.end_s - scenario.start_s, ENVELOPE[-1][1]), strict=True)
    since_start = tuple(scenario.start_s + x for x in t)
    limits = [("limit, fundamental", 1.02), ("limit, peak", 2.0)]
    return (
        Band(
            check="ride_through",
            quantity="voltage_positive_pu",
            name="ride-through envelope",
            t_s=since_start,
            lower=level,
        ),
        *(
            Band(check="current_limit", quantity="current_pu", name=name, t_s=whole, lower=(-x, -x), upper=(x, x))
            for name, x in limits
        ),
        Band(
            check="reactive_support",
            quantity="reactive_power_kvar",
            name="limit of Q",
            t_s=(during.start_s, during.end_s),
            lower=(160.7, 160.7),
        ),
    )


@pytest.fixture(scope="session")
def make_test(record: Waveforms, scenario: Scenario, nominal: Nominal) -> Callable[..., TestResult]:
    """Make a test with one verdict to choose: ``make_test(id, reactive=Status.PASS, **fields)``."""
    measurements = measure(record, nominal, scenario.start_s, scenario.clear_s)

    def make(name: str = "sag-90pct-c", reactive: Status = Status.PASS, **fields: Any) -> TestResult:
        defaults: dict[str, Any] = {
            "profile": "iec61400-21",
            "title": f"{scenario.sag.describe()}, {scenario.duration_s} s",
            "scenario": scenario.model_dump(mode="json"),
            "disturbance": disturbance_asked(scenario, NORMAL),
            "checks": _checks(reactive),
            "bands": _bands(scenario, measurements),
            "measurements": measurements,
            "clause": "8.5.2",
            "confidence": "memory",
            "duration_s": scenario.end_s,
            "waveforms": f"waveforms/{name}.cfg",
        }
        given = defaults | fields
        status = given.pop(
            "status", min((c.status for c in given["checks"]), key=list(Status).index, default=Status.PASS)
        )
        return TestResult(id=name, status=status, **given)

    return make


@pytest.fixture(scope="session")
def make_results() -> Callable[..., Results]:
    """Make the results of a run from its tests."""
    profile = ProfileSummary(
        id="iec61400-21",
        title="IEC 61400-21 voltage drops, Spanish demands",
        digest="5f1c9a" * 10,
        notes=(
            "ride_through envelope: inferred (NTS 631 Fig. 27)",
            "test VD1: memory (IEC 61400-21-1, not checked against the document)",
        ),
    )
    provenance = {
        "command": "pvlvrt-check --profile iec61400-21 --sag 90% --phases c",
        "created": "2024-01-01T00:00:00+00:00",
        "versions": {"pvlvrt-compliance": "0.1.0", "numpy": "2.4.6", "python": "3.11.7"},
        "parameters": {
            "controller": {"pr_integral_gain": 0.1, "sogi_gain": 1.4142135623730951},
            "plant": {"C": 0.065, "curve": [[0, 0], [1.5, 0.85]]},
        },
    }
    return lambda *tests: conclude(tests, [profile], provenance)


@pytest.fixture(scope="session")
def make_evidence(nominal: Nominal) -> Callable[..., Evidence]:
    """Make what a check sees of a record of a test: ``make_evidence(record, test)``."""

    def make(record: Waveforms, test: TestResult) -> Evidence:
        grid = test.disturbance
        return Evidence(
            waveforms=record,
            nominal=nominal,
            disturbance=grid,
            available_power_w=500e3,
            measurements=measure(record, nominal, grid.start_s, grid.clear_s),
            rules=STANDARD_RULES,
            blocked_below_pu=0.01,
        )

    return make


@pytest.fixture(scope="session")
def make_drawing(record: Waveforms, make_evidence: Callable[..., Evidence]) -> Callable[..., Drawing]:
    """Make the drawing of a test: ``make_drawing(test, record=the common one, **options)``."""
    common = record

    def make(test: TestResult, record: Waveforms = common, **options: Any) -> Drawing:
        return drawing(make_evidence(record, test), test, **options)

    return make
