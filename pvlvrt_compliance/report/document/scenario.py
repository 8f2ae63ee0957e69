"""The scenario of a test in words, and the voltages that the record has against those that were asked for."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.report.document.happenings import (
    event_words,
    grid_words,
    has_instant,
    is_something,
    plain,
    sag_words,
)
from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import TestResult, WindowMeasurements

_DIGITS = 3  # of a voltage in pu; the difference is that of the two as they are shown

_MOST_TOLD = 25
"""Events, or stretches that were found, that are told one by one; `results.json` has them all (chosen: half a page)."""

_ASKED = {
    *("sag", "duration_s", "point_on_wave_deg", "frequency_hz", "irradiance_w_m2", "cell_temperature_c"),
    *("before_s", "after_s"),
}
"""What a scenario of this version has; of one that lacks some of it nothing is told."""


class ScenarioWords(NamedTuple):
    """A test in words, whole sentences each; where times do not count from the start of the record, one says so."""

    happens: tuple[str, ...]  # what the grid and the sun do
    conditions: tuple[str, ...]  # when it starts, and what holds throughout
    demanded: tuple[str, ...]  # what a row of the test table asks of the inverter


class ImposedRow(NamedTuple):
    """Voltages of one window (pu), as text; empty where there is none."""

    name: str
    span: str  # of the window
    asked_positive: str
    measured_positive: str
    difference_positive: str
    asked_negative: str
    measured_negative: str
    difference_negative: str


def scenario_words(test: TestResult, texts: Texts) -> ScenarioWords:
    """What happens in a test, under which conditions, and what is demanded.

    Parameters
    ----------
    test : TestResult
        Of a record from the field, what was found in it is told instead of a scenario.
    texts : Texts
    """
    grid = test.disturbance
    if grid is not None and grid.origin == "found":
        return ScenarioWords(tuple(_found(grid, texts)), (), tuple(_demanded(test, texts)))
    happens, conditions = _happens(test.scenario, texts), _conditions(test.scenario, texts)
    return ScenarioWords(tuple(happens), tuple(conditions), tuple(_demanded(test, texts)))


def imposed_rows(test: TestResult, texts: Texts) -> tuple[ImposedRow, ...]:
    """V+ and V- at the terminals, by window, against those asked of the source without the inverter's current.

    Empty without a disturbance or without windows. Where the voltage moves in a window, what is asked is the mean;
    where the frequency or an angle does, a mean of phasors is no voltage, and the measured side stays empty.
    """
    grid, measured = test.disturbance, test.measurements
    if grid is None:
        return ()
    if measured.stretches:
        windows = [(texts.named("scenario.window", "before"), measured.before)]
        parts = enumerate(measured.stretches, start=1)
        windows += [(texts("scenario.stretch", number=number), part.window) for number, part in parts]
    else:
        names = ("before", "during", "after")
        windows = [(texts.named("scenario.window", name), getattr(measured, name)) for name in names]
    return tuple(_imposed(name, window, grid, texts) for name, window in windows if window is not None)


def _imposed(name: str, window: WindowMeasurements, grid: Disturbance, texts: Texts) -> ImposedRow:
    # A window lies inside one stretch, where the voltage holds or follows a straight line: its mean is in the middle.
    asked = grid.no_load((window.start_s + window.end_s) / 2)
    is_mean = grid.is_frequency_steady(window.start_s, window.end_s) and not any(
        window.start_s < at_s < window.end_s for at_s in grid.angle_steps_s
    )
    cells = []
    for wanted, found in (
        (asked.positive_pu, window.voltage_positive_pu),
        (asked.negative_pu, window.voltage_negative_pu),
    ):
        seen = found if is_mean else None
        difference = None if seen is None else round(seen, _DIGITS) - round(wanted, _DIGITS)
        cells += [_pu(wanted), _pu(seen), _pu(difference, sign=True)]
    span = texts("scenario.span", begin_s=number(window.start_s, "s"), end_s=number(window.end_s, "s"))
    return ImposedRow(name, span, *cells)


def _pu(value: float | None, sign: bool = False) -> str:
    return number(value, "pu", decimals=_DIGITS, sign=sign)


def _found(grid: Disturbance, texts: Texts) -> Iterator[str]:
    """What a record was found to hold; times count from its start."""
    yield texts("scenario.found.disturbance", start_s=number(grid.start_s, "s"), end_s=number(grid.end_s, "s"))
    abnormal = [stretch for stretch in grid.stretches if stretch.kind != "normal"]
    for stretch in abnormal[:_MOST_TOLD]:
        yield texts(
            f"scenario.found.{stretch.kind}",
            begin_s=number(stretch.begin_s, "s"),
            end_s=number(stretch.end_s, "s"),
            positive_pu=number(stretch.voltage.positive_pu, "pu"),
            negative_pu=number(stretch.voltage.negative_pu, "pu"),
        )
    yield from _not_told(abnormal, texts)


def _happens(scenario: Mapping[str, Any], texts: Texts) -> Iterator[str]:
    if not scenario.keys() >= _ASKED:
        return
    sag, events = scenario["sag"], scenario.get("events", ())
    if is_something(sag):
        yield sag_words(sag, scenario["duration_s"], texts)
    elif events:
        yield texts("scenario.events_alone", duration_s=number(scenario["duration_s"], "s"))
    else:
        yield texts("scenario.nothing")
    for event in events[:_MOST_TOLD]:
        yield from event_words(event, texts)
    yield from _not_told(events, texts)
    if any(map(has_instant, events)):
        yield texts("scenario.times")


def _not_told(items: Sequence[object], texts: Texts) -> Iterator[str]:
    """That there are more than anybody reads one by one."""
    if (count := len(items) - _MOST_TOLD) > 0:
        yield texts("scenario.further_events", count=count)


def _angle(scenario: Mapping[str, Any]) -> float:
    return float(scenario["point_on_wave_deg"])


def _conditions(scenario: Mapping[str, Any], texts: Texts) -> Iterator[str]:
    if not scenario.keys() >= _ASKED:
        return
    yield texts("scenario.start", start_s=number(scenario["before_s"], "s"), angle_deg=plain(_angle(scenario)))
    yield texts("scenario.frequency", hz=plain(scenario["frequency_hz"]))
    yield grid_words(scenario, texts, "grid")
    if scenario.get("vector_group"):
        yield texts("scenario.transformer", group=scenario["vector_group"])
    yield texts(
        "scenario.weather",
        irradiance=plain(scenario["irradiance_w_m2"]),
        temperature=plain(scenario["cell_temperature_c"]),
    )
    reactive = scenario.get("reactive_power_pu", 0.0)
    if reactive:
        yield texts(f"scenario.reactive.{'fed' if reactive > 0 else 'taken'}", pu=plain(abs(reactive)))
    yield texts("scenario.record", after_s=number(scenario["after_s"], "s"))


def _demanded(test: TestResult, texts: Texts) -> Iterator[str]:
    if test.expect is None:
        yield texts("scenario.demand.own")
    elif test.expect == "must_trip" and test.by_s is None:
        yield texts("scenario.demand.must_trip_at_all")
    else:
        yield texts(f"scenario.demand.{test.expect}", by_s=number(test.by_s, "s"))
    if test.k_factor is not None:
        yield texts("scenario.demand.k_factor", k=plain(test.k_factor))
