"""The measurements of a test as a table: a row a quantity, a column a window."""

from collections.abc import Callable
from typing import NamedTuple

from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import ControllerBeliefs, MeasuredWindows, WindowMeasurements

WINDOWS = ("before", "during", "after")


class Quantity(NamedTuple):
    """A quantity of the table: its name in the catalogue, its unit, and where it is in a window."""

    key: str
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
    Quantity("voltage_positive", "pu", lambda w: w.voltage_positive_pu),
    Quantity("voltage_negative", "pu", lambda w: w.voltage_negative_pu),
    Quantity("active_power", "kW", lambda w: w.active_power_kw),
    Quantity("reactive_power", "kvar", lambda w: w.reactive_power_kvar),
    Quantity("active_power_2f", "kW", lambda w: w.active_power_2f_kw),
    Quantity("current_a", "pu", _phase(0)),
    Quantity("current_b", "pu", _phase(1)),
    Quantity("current_c", "pu", _phase(2)),
    Quantity("current_peak", "pu", lambda w: w.current_peak_pu),
    Quantity("current_thd", "%", lambda w: w.current_thd_percent),
    Quantity("dc_voltage_mean", "V", lambda w: w.dc_voltage_mean_v),
    Quantity("dc_voltage_2f", "%", lambda w: w.dc_voltage_2f_percent),
    Quantity("frequency", "Hz", lambda w: w.frequency_hz),
)


def window_headings(measurements: MeasuredWindows, texts: Texts) -> list[tuple[str, str]]:
    """Name and span of each window."""
    return [_heading(name, getattr(measurements, name), texts) for name in WINDOWS]


def measured_rows(measurements: MeasuredWindows, texts: Texts) -> list[MeasuredRow]:
    """Rows of all quantities that at least one window has."""
    windows = [getattr(measurements, name) for name in WINDOWS]
    rows = [
        MeasuredRow(
            texts(f"section.quantity.{q.key}"),
            q.unit,
            tuple(number(q.of(w) if w else None, q.unit).removesuffix(f" {q.unit}") for w in windows),
        )
        for q in _QUANTITIES
    ]
    return [row for row in rows if any(row.values)]


def beliefs_in_words(beliefs: ControllerBeliefs | None, texts: Texts) -> str:
    """Names and values of what the controller believed, mean over the window `during`; empty when none is known."""
    if beliefs is None:
        return ""
    values = (
        ("fault_voltage", number(beliefs.v_fault_pu, "pu")),
        ("active_power", number(beliefs.p_ref_kw, "kW")),
        ("reactive_power", number(beliefs.q_ref_kvar, "kvar")),
    )
    return "; ".join(f"{texts(f'section.belief.{name}')} {text}" for name, text in values if text)


def _heading(name: str, window: WindowMeasurements | None, texts: Texts) -> tuple[str, str]:
    heading = texts(f"section.window.{name}")
    if window is None:
        return heading, texts("section.window.none")
    return heading, texts("section.window.span", begin=f"{window.start_s:.3f}", end=f"{window.end_s:.3f}")
