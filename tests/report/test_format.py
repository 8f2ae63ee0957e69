import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.evidence.evidence import after_trip
from pvlvrt_compliance.profile.requirements import BUILT_IN
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.language import BASE, Texts, catalogue, languages
from pvlvrt_compliance.results import Status, Verdict

SPANISH = Texts("es")

finite = st.floats(-1e9, 1e9, allow_nan=False)
units = st.sampled_from(["", "kvar", "pu", "%", "s", "furlong"])


@given(value=finite, unit=units)
def test_a_number_reads_back_close_to_its_value(value, unit):
    """What is printed is the value to the decimals of its unit, or to four significant digits."""
    text = spell.number(value, unit)
    printed = float(text.removesuffix(unit))
    assert math.isclose(printed, value, rel_tol=5.1e-4, abs_tol=0.051)
    assert not text.startswith("-") or printed < 0


@given(limit=st.floats(0.01, 1e4), margin=st.floats(1e-8, 1).map(lambda x: -x) | st.floats(1e-8, 1))
def test_a_margin_never_reads_as_zero(limit, margin):
    """A verdict that fails by little still shows by how much, in all three numbers alike."""
    check = Verdict(check="x", status=Status.FAIL, measured=limit - margin, limit=limit, margin=margin, unit="pu")
    numbers = spell.row(check)
    assert math.copysign(1, float(numbers.margin.removesuffix(" pu"))) == math.copysign(1, margin)
    assert float(numbers.margin.removesuffix(" pu")) != 0
    decimals = {text.removesuffix(" pu").partition(".")[2] for text in numbers[:3]}
    assert len({len(text) for text in decimals}) == 1


@pytest.mark.parametrize(
    ("margin", "texts"), [(2.498987, ("+2.499 kvar", "2.500 kvar")), (2.4, ("+2.4 kvar", "2.5 kvar"))]
)
def test_a_marginal_row_explains_itself(margin, texts):
    """Where margin and uncertainty round to one number, as many more digits are shown as tell them apart."""
    numbers = {"measured": 97.5 + margin, "limit": 100.0, "margin": margin, "tolerance": 2.5, "uncertainty": 2.5}
    check = Verdict(check="x", status=Status.PASS, unit="kvar", bound="at_least", **numbers)
    assert check.marginal
    row = spell.row(check)
    assert (row.margin, row.uncertainty) == texts


def test_an_uncertainty_as_large_as_the_margin_needs_no_further_digits():
    """Equal numbers are shown as equal; that is not marginal."""
    check = Verdict(check="x", status=Status.PASS, unit="kvar", measured=5, limit=2.5, margin=2.5, uncertainty=2.5)
    assert (spell.row(check).margin, spell.row(check).uncertainty) == ("+2.5 kvar", "2.5 kvar")


def test_nothing_measured_is_nothing_written():
    """Absent numbers are empty cells, not the word None."""
    assert spell.row(Verdict(check="x", status=Status.NOT_APPLICABLE)) == ("",) * 5


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (49.96, "kvar", "50.0 kvar"),
        (1.02, "pu", "1.020 pu"),
        (0.094, "%", "0.094 %"),
        (-1e-9, "pu", "0.000 pu"),
        (3, "", "3"),
    ],
)
def test_usual_numbers(value, unit, text):
    """Each unit has the decimals that its quantity is read with."""
    assert spell.number(value, unit) == text


def test_every_verdict_has_its_word_and_symbol():
    """No two verdicts look alike, with or without colour."""
    assert len({spell.STATUS_WORD[s] for s in Status}) == len({spell.STATUS_SYMBOL[s] for s in Status}) == len(Status)


@pytest.mark.parametrize(
    ("bound", "tolerance", "english", "spanish"),
    [
        ("at_least", 8.8, "at least 160.7 kvar, tolerance 8.8", "como mínimo 160.7 kvar, tolerancia 8.8"),
        ("at_most", 0.0, "at most 160.7 kvar", "como máximo 160.7 kvar"),
        ("band", 8.8, "within ±160.7 kvar, tolerance 8.8", "dentro de ±160.7 kvar, tolerancia 8.8"),
        (None, 0.0, "160.7 kvar", "160.7 kvar"),
    ],
)
def test_a_limit_says_its_kind_in_each_language(bound, tolerance, english, spanish):
    """At least, at most or within, with its tolerance; numbers keep the decimal point."""
    check = Verdict(
        check="x", status=Status.PASS, measured=170, limit=160.7, tolerance=tolerance, unit="kvar", bound=bound
    )
    assert spell.limit_in_words(check) == english
    assert spell.limit_in_words(check, SPANISH) == spanish


def test_connection_throughout_is_said_in_each_language():
    """A least time that nothing bounds has words in place of a number."""
    check = Verdict(check="ride_through", status=Status.FAIL, measured=0.8, unit="s", bound="at_least")
    assert (spell.limit_in_words(check), spell.limit_in_words(check, SPANISH)) == ("throughout", "en todo momento")


@pytest.mark.parametrize(
    ("value", "unit", "english", "spanish"),
    [
        (1, "runs", "1 run", "1 ensayo"),
        (2, "runs", "2 runs", "2 ensayos"),
        (0, "activations", "0 activations", "0 activaciones"),
        (50.1234, "Hz", "50.123 Hz", "50.123 Hz"),
    ],
)
def test_units_that_are_words_are_translated(value, unit, english, spanish):
    """A symbol is the same everywhere; a word has its number and its language."""
    assert spell.number(value, unit) == english
    assert spell.number(value, unit, texts=SPANISH) == spanish


def test_what_is_not_judged_after_a_trip_says_so():
    """The sentence that checks tell is read back: the instant to the millisecond, the status unchanged."""
    check = Verdict(
        check="harmonics", status=Status.NOT_APPLICABLE, message=f"{after_trip(0.8372)} by the relay of the plant"
    )
    assert check.after_trip_s == 0.837
    assert spell.state_in_words(check) == "not judged after the trip at 0.837 s"
    assert spell.state_in_words(check, SPANISH) == "no evaluado tras la desconexión a los 0.837 s"
    other = check.model_copy(update={"message": "the frequency never exceeds 50.2 Hz before the trip at 0.837 s"})
    assert spell.state_in_words(other) == "not applicable"
    assert spell.state_in_words(other, SPANISH) == "no aplicable"


@given(at_s=st.floats(0, 3600))
def test_any_trip_is_read_back(at_s):
    """Whatever the instant."""
    check = Verdict(check="x", status=Status.NOT_APPLICABLE, message=after_trip(at_s))
    assert check.after_trip_s == pytest.approx(at_s, abs=0.00051)


@pytest.mark.parametrize("language", languages())
def test_every_built_in_check_has_a_name_in_each_language(language):
    """No key is shown to a reader; in English it is the title that the check gives itself."""
    named = {kind: Texts(language).named("check", kind) for kind in BUILT_IN}
    assert all(f"check.{kind}" in catalogue(language) for kind in BUILT_IN)
    assert len(set(named.values())) == len(BUILT_IN)
    if language == BASE:
        assert named == {kind: find_check(kind).title for kind in BUILT_IN}


def test_a_margin_that_the_kind_of_limit_does_not_explain_is_shown_as_told():
    """A check of another package may count its margin otherwise."""
    check = Verdict(
        check="x", status=Status.PASS, measured=1.0, limit=2.0, margin=0.25, unit="pu", bound="at_most", tolerance=0.1
    )
    assert spell.row(check).margin == "+0.250 pu"


@given(
    measured=st.floats(-1e5, 1e5),
    gap=st.floats(1e-7, 10).flatmap(lambda x: st.sampled_from([x, -x])),
    tolerance=st.sampled_from([0.0, 0.001, 0.05, 10.0]),
    unit=st.sampled_from(["kW", "pu", "s", "%", "Hz", "", "furlong"]),
)
def test_the_sign_of_a_margin_is_that_of_the_verdict(measured, gap, tolerance, unit):
    """However near to its limit a value is: rounding never turns a failure into a pass, nor hides either."""
    limit = measured + gap - tolerance
    margin = limit + tolerance - measured
    check = Verdict(
        check="x", status=Status.PASS, measured=measured, limit=limit, tolerance=tolerance, margin=margin, unit=unit,
        bound="at_most",
    )  # fmt: skip
    shown = float(spell.bare(spell.row(check).margin))
    assert (shown > 0) - (shown < 0) == (margin > 0) - (margin < 0)
