"""Sags by depth and phases, their symmetrical components, and the scenario's instants."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from pvlvrt_compliance.scenario.sag import PAIRS, Sag, through_transformer
from pvlvrt_compliance.scenario.scenario import Scenario, nearest_nominal_frequency
from pvlvrt_compliance.space_vectors import phases

DEPTHS = st.floats(0, 1)


@given(DEPTHS)
def test_three_phase_sag_is_balanced(depth):
    """All phases down to r: V+ = r, V- = V0 = 0."""
    sequences = Sag(depth=depth).sequences_pu()
    assert [abs(x) for x in sequences] == pytest.approx([1 - depth, 0, 0], abs=1e-12)


@given(DEPTHS, st.sampled_from("abc"))
def test_single_phase_sag(depth, phase):
    """One phase down to r: V+ = (2 + r)/3, V- = V0 = (1 - r)/3, whichever phase it is."""
    r = 1 - depth
    sequences = Sag(depth=depth, phases=phase).sequences_pu()
    assert [abs(x) for x in sequences] == pytest.approx([(2 + r) / 3, depth / 3, depth / 3], abs=1e-12)


@given(DEPTHS, st.sampled_from(PAIRS))
def test_two_phases_to_neutral(depth, pair):
    """Two phases down to r against neutral: V+ = (1 + 2 r)/3, V- = V0 = (1 - r)/3."""
    r = 1 - depth
    sequences = Sag(depth=depth, phases=pair).sequences_pu()
    assert [abs(x) for x in sequences] == pytest.approx([(1 + 2 * r) / 3, depth / 3, depth / 3], abs=1e-12)


@given(DEPTHS, st.sampled_from(PAIRS))
def test_isolated_two_phase_sag(depth, pair):
    """The voltage between two phases down to r: V+ = (1 + r)/2, V- = (1 - r)/2, no zero sequence, third phase whole."""
    r = 1 - depth
    sag = Sag(depth=depth, phases=pair, two_phase=True)
    sequences = sag.sequences_pu()
    assert [abs(x) for x in sequences] == pytest.approx([(1 + r) / 2, (1 - r) / 2, 0], abs=1e-12)
    by_name = dict(zip("abc", sag.phasors_pu(), strict=True))
    assert abs(by_name[pair[0]] - by_name[pair[1]]) == pytest.approx(math.sqrt(3) * r, abs=1e-12)
    third = next(name for name in "abc" if name not in pair)
    assert by_name[third] == pytest.approx(dict(zip("abc", Sag(depth=0).phasors_pu(), strict=True))[third])


@given(DEPTHS, st.sampled_from(["abc", "a", "b", "c", *PAIRS]))
def test_angles_stay(depth, names):
    """A sag to neutral changes magnitudes and no angle; the healthy phases keep theirs too."""
    for sagged, healthy in zip(Sag(depth=depth, phases=names).phasors_pu(), Sag(depth=0).phasors_pu(), strict=True):
        assert (sagged / healthy).imag == pytest.approx(0, abs=1e-12)
        assert abs(sagged) == pytest.approx(1) or abs(sagged) == pytest.approx(1 - depth)


@given(DEPTHS, st.sampled_from(PAIRS), st.booleans())
def test_sequences_and_phasors_are_two_views(depth, pair, two_phase):
    """The phasors come back from their symmetrical components."""
    sag = Sag(depth=depth, phases=pair, two_phase=two_phase)
    assert list(phases(*sag.sequences_pu())) == pytest.approx(list(sag.phasors_pu()), abs=1e-12)


def test_healthy_grid_turns_forward():
    """Phase b lags phase a by 120 degrees."""
    a, b, _ = Sag(depth=0).phasors_pu()
    assert math.degrees(cmath.phase(a / b)) == pytest.approx(120)


@pytest.mark.parametrize("names", ["abc", "a", "b", "c"])
def test_two_phase_sag_needs_a_pair(names):
    """An isolated two-phase sag of one or three phases is refused."""
    with pytest.raises(ValidationError, match="needs a pair"):
        Sag(depth=0.5, phases=names, two_phase=True)


@pytest.mark.parametrize("depth", [-0.1, 1.2, math.nan])
def test_depth_out_of_range(depth):
    """A depth outside 0 to 1 is refused."""
    with pytest.raises(ValidationError):
        Sag(depth=depth)


@pytest.mark.parametrize(
    ("sag", "words"),
    [
        (Sag(depth=0), "no sag"),
        (Sag(depth=0.9), "three-phase, 90 %"),
        (Sag(depth=0.5, phases="c"), "phase c, 50 %"),
        (Sag(depth=0.5, phases="ab"), "phases ab, 50 %"),
        (Sag(depth=0.8, phases="bc", two_phase=True), "isolated two-phase bc, 80 %"),
    ],
)
def test_sag_in_words(sag, words):
    """A sag is named by its kind, its phases and its depth."""
    assert sag.describe() == words


def test_instants_of_a_scenario():
    """Start, clearing and end follow from the three durations."""
    scenario = Scenario(sag=Sag(depth=0.9), duration_s=0.5, before_s=0.3, after_s=1.1)
    assert (scenario.start_s, scenario.clear_s, scenario.end_s) == pytest.approx((0.3, 0.8, 1.9))


@pytest.mark.parametrize(("grid_hz", "nominal_hz"), [(49.2, 50), (50, 50), (54.9, 50), (55.1, 60), (60, 60), (62, 60)])
def test_nominal_frequency(grid_hz, nominal_hz):
    """A grid belongs to the nearer of 50 and 60 Hz."""
    assert nearest_nominal_frequency(grid_hz) == nominal_hz
    scenario = Scenario(sag=Sag(depth=0.9), duration_s=0.5, frequency_hz=grid_hz)
    assert scenario.nominal_frequency_hz == nominal_hz


@pytest.mark.parametrize(
    "field", [{"duration_s": 0}, {"duration_s": -1}, {"scr": 0.1}, {"frequency_hz": 40}, {"depth": 0.9}]
)
def test_scenario_out_of_range(field):
    """Values outside their range and unknown names are refused."""
    with pytest.raises(ValidationError):
        Scenario(**({"sag": Sag(depth=0.9), "duration_s": 0.5} | field))


# Bollen's types in the form V+ and V- have: closed forms of the characteristic voltage V, symmetrical phase a.
TYPES = {
    "A": lambda V: (V, 0, 0),
    "B": lambda V: ((2 + V) / 3, -(1 - V) / 3, -(1 - V) / 3),
    "C": lambda V: ((1 + V) / 2, (1 - V) / 2, 0),
    "D": lambda V: ((1 + V) / 2, -(1 - V) / 2, 0),
    "E": lambda V: ((1 + 2 * V) / 3, (1 - V) / 3, (1 - V) / 3),
    "F": lambda V: ((1 + 2 * V) / 3, -(1 - V) / 3, 0),
    "G": lambda V: ((1 + 2 * V) / 3, (1 - V) / 3, 0),
}


@given(DEPTHS, st.sampled_from(sorted(TYPES)))
def test_types_a_to_g(depth, name):
    """Each of Bollen's types has the sequences that its definition gives."""
    assert Sag(depth=depth, type=name).sequences_pu() == pytest.approx(TYPES[name](1 - depth), abs=1e-12)


@given(DEPTHS, st.sampled_from(sorted(TYPES)), st.sampled_from("abc"))
def test_symmetrical_phase(depth, name, phase):
    """Another symmetrical phase gives the same three magnitudes, moved on."""
    a, b, c = (abs(u) for u in Sag(depth=depth, type=name).phasors_pu())
    moved = {"a": (a, b, c), "b": (c, a, b), "c": (b, c, a)}[phase]
    assert [abs(u) for u in Sag(depth=depth, type=name, phases=phase).phasors_pu()] == pytest.approx(moved)


@given(DEPTHS, st.sampled_from([("B", 3.0, "Dyn11"), ("C", 1.0, "Dyn1"), ("E", 1.0, "Dyn5")]))
def test_fault_beyond_a_delta_star_transformer(depth, case):
    """Through a delta-star transformer type B is seen as C with V = (1 + 2 V')/3, C as D, and E as F."""
    name, divisor, group = case
    seen = {"B": "C", "C": "D", "E": "F"}[name]
    found = through_transformer(Sag(depth=depth, type=name).sequences_pu(), group)
    expected = Sag(depth=depth * (2 / divisor if name == "B" else 1), type=seen)
    assert sorted(map(abs, phases(*found))) == pytest.approx(sorted(map(abs, expected.phasors_pu())), abs=1e-9)


@given(DEPTHS)
def test_star_star_transformer(depth):
    """A star-star transformer takes the zero sequence away, and an earthed one takes nothing."""
    sequences = Sag(depth=depth, phases="a").sequences_pu()
    assert through_transformer(sequences, "Yyn0") == pytest.approx((sequences.positive, sequences.negative, 0))
    assert through_transformer(sequences, "YNyn0") == pytest.approx(sequences)
