import contextlib
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.units import (
    ANGLE,
    FREQUENCY,
    IRRADIANCE,
    RATIO,
    TEMPERATURE,
    Nominal,
    parse_duration,
    parse_fraction,
    parse_quantity,
)


@given(st.floats(0, 1))
def test_a_fraction_is_read_as_written(value):
    """Any fraction from 0 to 1 that Python prints is read back unchanged."""
    assert parse_fraction(repr(value), "--sag") == value


@given(st.floats(0, 100))
def test_percent_is_a_hundredth(value):
    """With a percent sign the value is a hundredth of the number, blanks or not."""
    assert parse_fraction(f" {value!r} %", "--sag") == pytest.approx(value / 100)


@given(st.floats(1, exclude_min=True, allow_infinity=False))
def test_more_than_the_whole_is_refused(value):
    """A fraction above 1 is refused, and so is its negative, with the name of the option."""
    for text in (repr(value), repr(-value), f"{-value!r}%"):
        with pytest.raises(UsageError, match=r"--sag: .*outside 0% to 100%"):
            parse_fraction(text, "--sag")


def test_a_forgotten_percent_sign_is_suggested():
    """The number 90 alone is refused with the spelling that was probably meant."""
    with pytest.raises(UsageError, match='for 90 percent write "90%"'):
        parse_fraction("90", "--sag")


@pytest.mark.parametrize("text", ["", "abc", "nan", "inf", "90%%", "0,9", "9 0%", "0x1", "1e", "%", "--1"])
def test_what_is_no_fraction_is_refused(text):
    """Words, commas and anything but one number are refused."""
    with pytest.raises(UsageError, match=r"write 90% or 0\.9"):
        parse_fraction(text, "--sag")


@given(st.text(max_size=12))
def test_any_text_is_a_value_or_a_usage_error(text):
    """No text makes the readers raise anything but a usage error, or return what is out of range."""
    with contextlib.suppress(UsageError):
        assert 0 <= parse_fraction(text, "--sag") <= 1
    with contextlib.suppress(UsageError):
        assert 0 < parse_duration(text, "--duration") < math.inf
    for quantity in (FREQUENCY, TEMPERATURE, ANGLE, IRRADIANCE, RATIO):
        with contextlib.suppress(UsageError):
            assert math.isfinite(parse_quantity(text, "--x", quantity))


@given(st.floats(1e-6, 1e6))
def test_a_duration_in_seconds_and_milliseconds(value):
    """A duration is in seconds or in milliseconds, as its unit says."""
    assert parse_duration(f"{value!r}s", "--duration") == value
    assert parse_duration(f"{value!r} ms", "--duration") == pytest.approx(value / 1000)


@pytest.mark.parametrize("text", ["0.5", "500", "ms", "0.5 m", "5 min", "s", "1s2ms", "nans", "infs"])
def test_a_duration_needs_a_number_and_a_unit(text):
    """A duration without a known unit or a number is refused."""
    with pytest.raises(UsageError, match=r"write 500ms or 0\.5s"):
        parse_duration(text, "--duration")


@pytest.mark.parametrize("text", ["0s", "-1s", "-0.5ms", "0ms"])
def test_a_duration_is_longer_than_zero(text):
    """Zero and negative durations are refused."""
    with pytest.raises(UsageError, match="longer than zero"):
        parse_duration(text, "--duration")


def test_the_bases_of_the_reference_plant():
    """500 kVA at 230 V: 1024.8 A and 325.3 V of phase amplitude, 398.4 V and 1255 A of space vector."""
    nominal = Nominal()
    assert nominal.phase_current_peak_a == pytest.approx(1024.8, abs=0.05)
    assert nominal.phase_voltage_peak_v == pytest.approx(325.27, abs=0.005)
    assert nominal.voltage_ab_v == pytest.approx(398.4, abs=0.05)
    assert nominal.current_ab_a == pytest.approx(1255, abs=0.5)
    assert nominal.impedance_ohm == pytest.approx(0.3174)


@given(st.floats(1, 1e9), st.floats(1, 1e6))
def test_the_bases_belong_together(power_va, voltage_v):
    """Nominal voltage and current make the nominal power, as phase amplitudes, as space vectors and by Ohm's law."""
    n = Nominal(power_va, voltage_v)
    assert 1.5 * n.phase_voltage_peak_v * n.phase_current_peak_a == pytest.approx(power_va)
    assert n.voltage_ab_v * n.current_ab_a == pytest.approx(power_va)
    assert n.voltage_ab_v == pytest.approx(n.impedance_ohm * n.current_ab_a)


@pytest.mark.parametrize(
    ("quantity", "spellings", "value"),
    [
        (FREQUENCY, ("50", "50Hz", " 50 hz ", "5e1 HZ", "0.05kHz", "0.05 khz", "+50.0Hz"), 50),
        (TEMPERATURE, ("-45", "-45C", "-45 degC", "-45°C", "-45 c"), -45),
        (ANGLE, ("-90", "-90deg", "-90 °"), -90),
        (IRRADIANCE, ("800", "800W/m2", "800 W/m²", "0.8kW/m2", ".8 kW/m^2", "800 w / m2"), 800),
        (RATIO, ("2.5", "25e-1"), 2.5),
    ],
)
def test_a_quantity_is_read_with_its_usual_units(quantity, spellings, value):
    """Any usual spelling is one number; one without a unit is in the first of them."""
    for text in spellings:
        assert parse_quantity(text, "--x", quantity) == pytest.approx(value, rel=1e-15)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_alone_is_read_as_written(value):
    """Whatever Python prints of a finite number is read back unchanged, for every quantity."""
    for quantity in (FREQUENCY, TEMPERATURE, ANGLE, IRRADIANCE, RATIO):
        assert parse_quantity(repr(value), "--x", quantity) == value


@pytest.mark.parametrize(
    "text", ["", "fast", "nan", "inf", "1e999", "50Hz Hz", "5 0", "5.5.5", "Hz", "50 m", "1,5", "1.000,5"]
)
def test_what_is_no_quantity_is_refused(text):
    """Words, other units, commas and more than one number are refused, by the name of the option."""
    with pytest.raises(UsageError, match=r"^--frequency: "):
        parse_quantity(text, "--frequency", FREQUENCY)


@pytest.mark.parametrize(
    ("text", "spelled"),
    [("0,5s", "0.5s"), ("1,25 s", "1.25 s"), ("1,000ms", "1.000ms or 1000ms")],
)
def test_a_comma_is_told_with_what_may_be_meant(text, spelled):
    """A decimal comma is no point, and behind a comma of three digits there may be thousands."""
    with pytest.raises(UsageError, match=f"has a comma: {spelled}; write"):
        parse_duration(text, "--duration")
