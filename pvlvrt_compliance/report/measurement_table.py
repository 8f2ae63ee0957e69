"""The measurements of a test as a table: a row a quantity, a column a window."""

from collections.abc import Callable
from typing import NamedTuple

from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.results import ControllerBeliefs, MeasuredWindows, WindowMeasurements

WINDOWS = ("before", "during", "after")


class Quantity(NamedTuple):
    """A quantity of the table: its name for people, its unit, and where it is in a window."""

    name: str
    unit: str
    of: Callable[[WindowMeasurements], float | None]


class MeasuredRow(NamedTuple):
    """A row of the table; ``values`` in the order of `WINDOWS`, empty where there is none."""

    name: str
    unit: str
    values: tuple[str, ...]


def _phase(index: int) -> Callable[[WindowMeasurements], float | None]:
    return lambda window: window.current_phase_pu[index] if window.current_phase_pu else None


_QUANTITIES = (
    Quantity("positive-sequence voltage", "pu", lambda w: w.voltage_positive_pu),
    Quantity("negative-sequence voltage", "pu", lambda w: w.voltage_negative_pu),
    Quantity("active power", "kW", lambda w: w.active_power_kw),
    Quantity("reactive power", "kvar", lambda w: w.reactive_power_kvar),
    Quantity("active power at twice the frequency", "kW", lambda w: w.active_power_2f_kw),
    Quantity("fundamental current, phase a", "pu", _phase(0)),
    Quantity("fundamental current, phase b", "pu", _phase(1)),
    Quantity("fundamental current, phase c", "pu", _phase(2)),
    Quantity("largest instantaneous current *", "pu", lambda w: w.current_peak_pu),
    Quantity("current distortion (THD), worst phase", "%", lambda w: w.current_thd_percent),
    Quantity("DC voltage, mean", "V", lambda w: w.dc_voltage_mean_v),
    Quantity("DC voltage ripple at twice the frequency", "%", lambda w: w.dc_voltage_2f_percent),
    Quantity("frequency", "Hz", lambda w: w.frequency_hz),
)


def window_headings(measurements: MeasuredWindows) -> list[tuple[str, str]]:
    """Name and span of each window."""
    return [_heading(name, getattr(measurements, name)) for name in WINDOWS]


def measured_rows(measurements: MeasuredWindows) -> list[MeasuredRow]:
    """Rows of all quantities that at least one window has."""
    windows = [getattr(measurements, name) for name in WINDOWS]
    rows = [
        MeasuredRow(
            q.name, q.unit, tuple(number(q.of(w) if w else None, q.unit).removesuffix(f" {q.unit}") for w in windows)
        )
        for q in _QUANTITIES
    ]
    return [row for row in rows if any(row.values)]


def belief_rows(beliefs: ControllerBeliefs | None) -> list[tuple[str, str]]:
    """Name and value of what the controller believed, mean over the window `during`."""
    if beliefs is None:
        return []
    values = (
        ("fault voltage", number(beliefs.v_fault_pu, "pu")),
        ("active power asked for", number(beliefs.p_ref_kw, "kW")),
        ("reactive power asked for", number(beliefs.q_ref_kvar, "kvar")),
    )
    return [(name, text) for name, text in values if text]


def _heading(name: str, window: WindowMeasurements | None) -> tuple[str, str]:
    if window is None:
        return name, "not in the record"
    return name, f"{window.start_s:.3f} s to {window.end_s:.3f} s"
