"""The program is no echo: with one definition changed in the package, it no longer comes to the same numbers."""

import json
from functools import cached_property

import numpy as np
import pytest

from forty_tests import FIFTH, INNER, SECOND, WEAK, WEAKER, own, run, written
from pvlvrt_compliance.checks.connection import envelopes, recoveries
from pvlvrt_compliance.checks.current import reactive_current, reactive_support
from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.checks.power import active_power_support, oscillation
from pvlvrt_compliance.checks.quality import harmonics
from pvlvrt_compliance.evidence import cursors as set_cursors
from pvlvrt_compliance.evidence import evidence, excursions, series
from pvlvrt_compliance.evidence.record import Record
from pvlvrt_compliance.measure import swing, window_sums, windows
from pvlvrt_compliance.measure.extremes import first_least
from pvlvrt_compliance.measure.groups import harmonic_subgroups
from pvlvrt_compliance.measure.power import Power, SequenceCurrent, instantaneous_power
from pvlvrt_compliance.measure.response import step_response
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.units import Nominal
from recomputing import cursors, judge
from recomputing.comparing import differences, read_csv

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    """Records of cases, simulated once each, and what the program makes of them."""
    known = {}

    def of(case):
        if case.name not in known:
            found = run(case)
            profile = json.loads(found.profile.model_dump_json(by_alias=True, exclude_none=True))
            waveforms = read_csv(written(found, tmp_path_factory.mktemp("case")))
            known[case.name] = found, judge(json.loads(found.result.model_dump_json()), profile, waveforms)
        return known[case.name]

    return of


def _start_kept(span, frequency_hz):
    cycles = int((span.end_s - span.start_s) * frequency_hz + 1e-3)
    return Span(span.start_s, span.start_s + cycles / frequency_hz) if cycles >= 1 else None


def _leading(segment):
    p, q = instantaneous_power(segment)
    return Power(p, -q)


def _centred(self, function, *_):
    found = np.concatenate([function(segment) for segment in self.waveforms], axis=-1)
    half = round(0.5 / self.frequency_hz / self.waveforms.segments[0].dt_s)
    return np.concatenate([found[..., half:], np.repeat(found[..., -1:], half, axis=-1)], axis=-1)


def _settled_early(begin_s, end_s, frequency_hz, rules):
    return windows.stretch_window(begin_s - 0.05, end_s, frequency_hz, 1.1, rules)


def _at_terminals(seen, quantity, place="terminals"):  # noqa: ARG001
    return seen.voltage_positive_pu


NTS, PAPER, IEEE = "es-nts-631-lt110kv", "spain-q-curve", "ieee1547-cat-iii"
DEEPER = {"kind": "voltage_profile", "points": [[0, 0.3], [0.7, 0.3], [0.7, 0.15], [1.1, 0.15], [1.1, 1.0]]}
ROOM_PU = active_power_support.room_pu
WEAK_SAG = own("iec61400-21", 0.56, 0.5, **WEAK)
SINGLE = own(NTS, 0.8, 0.3, phases="a")
CHANGES = {
    "a window keeps its beginning": (own("iec61400-21", 0.56, 0.513, **WEAK), windows, "_shorten", _start_kept),
    "currents are per unit of rms": (
        own(PAPER, 0.5, 0.3),
        Nominal,
        "phase_current_peak_a",
        property(lambda self: self.apparent_power_va / (3 * self.phase_voltage_v)),
    ),
    "voltages are per unit of rms": (
        own(PAPER, 0.4, 0.3),
        Nominal,
        "phase_voltage_peak_v",
        property(lambda self: self.phase_voltage_v),
    ),
    "swings are of one-cycle means": (
        WEAK_SAG,
        series.Series,
        "half_cycle_kva",
        property(lambda self: Power(self.active_power_kw, self.reactive_power_kvar)),
    ),
    "swings count what goes one way only": (own(PAPER, 0.5, 0.15, SECOND), swing, "to_and_fro", np.ptp),
    "the larger of P and Q is the smaller": (WEAK_SAG, oscillation, "first_most", first_least),
    "reactive power leads": (own(PAPER, 0.5, 0.3), window_sums, "instantaneous_power", _leading),
    "the negative sequence counts as the positive": (
        SINGLE,
        series,
        "SequenceCurrent",  # which is made of the negative sequence alone there
        lambda active, reactive: SequenceCurrent(active, -reactive),
    ),
    "a stretch is settled after 50 ms": (WEAK_SAG, evidence, "settled_window", _settled_early),
    "an envelope goes by the terminals": (
        own("iec61400-21", 0.9, 0.3, **WEAKER),
        envelopes,
        "voltage_quantity_pu",
        _at_terminals,
    ),
    "an envelope is left a cycle late": (
        own("iec61400-21", 0.9, 0.6),
        envelopes,
        "_at_its_step",
        lambda left_s, *_: left_s + 0.02,
    ),
    "a region is left when the measurement shows it": (
        own(IEEE, 0.7, 1.3),
        excursions,
        "_anchored",
        lambda at_s, *_: at_s,
    ),
    "a cycle is centred": (own(PAPER, 0.5, 0.3), series.Series, "_of_cycles", _centred),
    "a dead band shifts": (
        own(NTS, 0.4, 0.4),
        reactive_current,
        "beyond_dead_band",
        lambda delta, band, mode: delta - band,  # noqa: ARG005
    ),
    "the current before does not count": (
        own(NTS, 0.4, 0.4, reactive_power_pu=0.2),
        reactive_current,
        "reactive_before",
        lambda *_: 0.0,
    ),
    "the tolerance of Q is of S": (
        own(PAPER, 0.5, 0.3),
        reactive_support,
        "_tolerance_kvar",
        lambda requirement, seen, _: requirement.tolerance_pu.value * seen.nominal.apparent_power_kva,
    ),
    "eq (10) holds at the voltage itself": (
        own(PAPER, 0.4, 0.3),
        active_power_support,
        "room_pu",
        lambda support, positive, negative, _: ROOM_PU(support, positive, negative, 0.0),
    ),
    "harmonics are amplitudes": (
        own(IEEE, 0.3, 0.3, FIFTH),
        harmonics,
        "harmonic_subgroups",
        lambda found: np.sqrt(2) * harmonic_subgroups(found),
    ),
    "only the first sag is judged": (
        own(PAPER, 0.3, 0.6, INNER),
        evidence.Evidence,
        "disturbed_until",
        lambda self, until: self.stretches_until(until)[:1],
    ),
    "only the last return counts": (own("es-po-12.3", 0.5, 0.15, SECOND), recoveries, "pairwise", lambda _: iter(())),
    "what is due ends with the trip": (
        own("iec61400-21", 0.0, 1.1, DEEPER),
        evidence.Evidence,
        "released_at_s",
        cached_property(lambda self: None),  # noqa: ARG005
    ),
}


@pytest.mark.parametrize("what", CHANGES)
def test_changed_definition_is_noticed(what, simulated, monkeypatch):
    """With the definition as it is every verdict is recomputed; changed in the package, one at least is not."""
    case, where, name, changed = CHANGES[what]
    found, recomputed = simulated(case)
    as_it_is = {check.check: json.loads(check.model_dump_json()) for check in found.result.checks}
    assert [text for verdict in recomputed for text in differences(as_it_is[verdict.check], verdict)] == []
    if isinstance(changed, cached_property):
        changed.__set_name__(where, name)
    monkeypatch.setattr(where, name, changed, raising=name != "max")
    nominal = Nominal(frequency_hz=found.result.rating.frequency_hz)
    again = evaluate(found.profile, found.test, found.waveforms, nominal, 1e3 * found.result.available_power_kw)
    other = {check.check: json.loads(check.model_dump_json()) for check in again.checks}
    assert [text for verdict in recomputed for text in differences(other[verdict.check], verdict)] != []


OF_CURSORS = {
    "extremes count from the step": (set_cursors, "settling_s", lambda _: 0.0),
    "what is reached is the whole settled window": (
        set_cursors,
        "last_window",
        lambda begin_s, end_s, hz, rules: windows.settled_window(begin_s, end_s - 0.08, hz, rules),
    ),
    "times count a cycle late": (
        set_cursors,
        "step_response",
        lambda t_s, x, event_s, *levels: step_response(t_s, x, event_s + 0.02, *levels),
    ),
    "the frequency is not held": (set_cursors, "frequency_hz", lambda seen: seen.tracked_frequency_hz),
    "the current is the mean of the phases": (
        Record,
        "largest_current_pu",
        property(lambda self: np.mean(self.current_phase_pu, axis=0)),
    ),
}


@pytest.fixture(scope="module")
def with_cursors(tmp_path_factory):
    """A fault of one phase with a step of the frequency in it, and its cursors recomputed."""
    found = run(own(NTS, 0.8, 0.3, {"kind": "frequency_step", "t_s": 0.1, "to_hz": 50.5}, phases="a"))
    profile = json.loads(found.profile.model_dump_json(by_alias=True, exclude_none=True))
    waveforms = read_csv(written(found, tmp_path_factory.mktemp("cursors")))
    return found, cursors.recompute(json.loads(found.result.model_dump_json()), profile, waveforms)


@pytest.mark.parametrize("what", OF_CURSORS)
def test_changed_cursor_is_noticed(what, with_cursors, monkeypatch):
    """With the definition as it is every cursor is recomputed; changed in the package, one at least is not."""
    found, redone = with_cursors
    assert cursors.differences(json.loads(found.result.model_dump_json())["cursors"], redone) == []
    monkeypatch.setattr(*OF_CURSORS[what])
    nominal = Nominal(frequency_hz=found.result.rating.frequency_hz)
    again = evaluate(found.profile, found.test, found.waveforms, nominal, 1e3 * found.result.available_power_kw)
    assert cursors.differences(json.loads(again.model_dump_json())["cursors"], redone) != []
