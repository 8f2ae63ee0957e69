"""Golden cases: a folder each, with input, expected values and where they come from."""

import tomllib
from functools import cache
from pathlib import Path

import pytest

from pvlvrt_compliance.measure.fourier import component
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.translate import nominal_of

FOLDER = Path(__file__).parent


@cache
def _run(name):
    table = tomllib.loads((FOLDER / name / "input.toml").read_text("utf-8"))
    scenario = Scenario.model_validate(table["scenario"])
    parameters = parameters_from(table.get("parameters", []))
    waveforms = simulate(scenario, parameters)
    nominal = nominal_of(parameters, scenario)
    return waveforms, scenario, measure(waveforms, nominal, scenario.start_s, scenario.clear_s)


def _measured(name, item):
    """What a golden case measures for one expected value."""
    waveforms, scenario, measurements = _run(name)
    quantity = item["quantity"]
    window = getattr(measurements, item["window"]) if "window" in item else None
    if window is not None and hasattr(window, quantity):
        return getattr(window, quantity)
    if quantity == "current_phase_max_pu":
        return max(window.current_phase_pu)
    span = Span(window.start_s, window.end_s) if window is not None else Span(item["start_s"], item["end_s"])
    segment = waveforms.window(*span)
    power = instantaneous_power(segment)
    if quantity == "connected":
        return segment["connected"].min()
    if quantity in {"active_power_kw", "reactive_power_kvar"}:
        return float((power.p if quantity.startswith("active") else power.q).mean()) / 1e3
    signal = power.p if quantity == "active_power_6f_kw" else power.q
    return abs(component(signal, segment.dt_s, 6 * scenario.frequency_hz)) / 1e3


@pytest.fixture(scope="session")
def measured():
    """Measure one expected value of a case: ``measured(case, item) -> float``; each case runs once."""
    return _measured


def _when(item):
    return item["window"] if "window" in item else f"{item['start_s']:g}s"


def pytest_generate_tests(metafunc):
    """One test for each expected value of each case."""
    if "expected" in metafunc.fixturenames:
        cases = [
            pytest.param(
                folder.name, item, id=f"{folder.name}-{item['quantity']}-{item.get('window', item.get('end_s'))}"
            )
            for folder in sorted(FOLDER.iterdir())
            if (folder / "expected.toml").is_file()
            for item in tomllib.loads((folder / "expected.toml").read_text("utf-8"))["expected"]
        ]
        assert cases
        metafunc.parametrize(("case", "expected"), cases)
