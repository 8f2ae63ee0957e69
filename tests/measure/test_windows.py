import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.measure.windows import Span, WindowRules, Windows, standard_windows, stretch_window


def test_the_windows_of_the_main_job():
    """A sag from 0.3 s to 0.609 s at 50 Hz: 0.2 s before, 0.18 s during, the last 0.2 s after."""
    windows = standard_windows(0.3, 0.609, 1.709, 50)
    assert windows.before == pytest.approx((0.08, 0.28))
    assert windows.during == pytest.approx((0.409, 0.589))
    assert windows.after == pytest.approx((1.509, 1.709))


@given(st.floats(45, 66), st.floats(0.001, 3), st.floats(0, 2))
def test_windows_hold_whole_cycles_and_keep_their_ends(frequency_hz, duration_s, after_s):
    """Every window is a whole number of cycles that ends where the rules say, less than a cycle short of them."""
    clear_s = 0.3 + duration_s
    windows = standard_windows(0.3, clear_s, clear_s + after_s, frequency_hz)
    ideals = Windows(Span(0.08, 0.28), Span(0.4, clear_s - 0.02), Span(clear_s + after_s - 0.2, clear_s + after_s))
    for window, ideal in zip(windows, ideals, strict=True):
        if window is None:
            continue
        cycles = (window.end_s - window.start_s) * frequency_hz
        assert cycles == pytest.approx(round(cycles), abs=1e-9)
        assert window.end_s == pytest.approx(ideal.end_s)
        assert -2e-3 < (window.start_s - ideal.start_s) * frequency_hz < 1


def test_a_short_sag_has_no_window_during_it():
    """Between 100 ms after the start and 20 ms before clearing there must be a cycle."""
    assert standard_windows(0.3, 0.3 + 0.139, 2, 50).during is None
    assert standard_windows(0.3, 0.3 + 0.141, 2, 50).during == pytest.approx((0.401, 0.421))


def test_a_record_that_ends_early_has_no_window_after():
    """The window after needs 1.1 s past clearing, less what the last sampling step takes."""
    assert standard_windows(0.3, 0.6, 1.68, 50).after is None
    assert standard_windows(0.3, 0.6, 1.69996, 50).after is not None


def test_a_record_that_starts_late_has_no_window_before():
    """The window before needs its record; a recording may start at a time of its own."""
    assert standard_windows(0.2, 0.6, 2, 50).before is None
    assert standard_windows(0.2, 0.6, 2, 50, record_start_s=-0.5).before == pytest.approx((-0.02, 0.18))


def test_a_frequency_a_hair_low_costs_no_cycle():
    """Ten cycles of 49.999 Hz are measured in a window of 0.2 s."""
    before = standard_windows(0.3, 0.6, 2, 49.999).before
    assert before.end_s - before.start_s == pytest.approx(10 / 49.999)


def test_a_profile_states_other_windows():
    """The rules are data."""
    rules = WindowRules(before_start_s=0.12, during_start_s=0.06, after_length_s=0.1, after_clearing_s=0.3)
    windows = standard_windows(0.3, 0.5, 0.9, 50, rules)
    assert windows.before == pytest.approx((0.18, 0.28))
    assert windows.during == pytest.approx((0.36, 0.48))
    assert windows.after == pytest.approx((0.8, 0.9))


@pytest.mark.parametrize(
    ("lasts_s", "expected"),
    [
        (0.5, (0.10, 0.48)),  # as `during` in a sag
        (0.145, (0.105, 0.125)),  # one cycle of it
        (0.1, (0.02, 0.1)),  # all that is settled
        (0.0225, (0.0025, 0.0225)),  # one cycle, over 1.1 cycles after the step
        (0.0215, None),
    ],
)
def test_window_of_a_stretch(lasts_s, expected):
    """A stretch is measured as a sag is; a short one in all its whole settled cycles, or not at all."""
    found = stretch_window(1.0, 1.0 + lasts_s, 50.0, 1.1)
    assert found == (None if expected is None else pytest.approx([1.0 + t for t in expected]))
