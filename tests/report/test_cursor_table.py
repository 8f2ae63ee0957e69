"""The cursor table: numbers with the digits of their unit, in a language, and a dash for what is not told."""

import pytest

from pvlvrt_compliance.report.cursor_table import COLUMNS, cursor_parts, headings, note
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.report.language import Texts, languages
from pvlvrt_compliance.results import Cursor, CursorStretch

BEFORE = Cursor(quantity="active_power_kw", minimum=499.949, maximum=500.051, mean=500.0)
TIMED = Cursor(
    quantity="voltage_positive_pu",
    minimum=0.39996,
    maximum=0.4001,
    mean=0.4,
    initial=1.0,
    final=0.4,
    reaction_s=0.0021,
    rise_s=0.016,
    response_s=0.0181,
    overshoot_percent=1.25,
)
STRETCHES = (
    CursorStretch(begin_s=0.08, end_s=0.28, is_before=True, cursors=(BEFORE,)),
    CursorStretch(begin_s=0.3, end_s=0.8, band_percent=10, cursors=(TIMED,)),
    CursorStretch(begin_s=0.8, end_s=0.81),
)


@pytest.fixture
def with_cursors(make_test):
    """A test with the cursors above, in whose first stretch the voltage is a recorded one."""
    recording = {"kind": "recording", "t_s": 0.0, "file": "<deep>.csv"}
    test = make_test()
    scenario = test.scenario | {"sag": test.scenario["sag"] | {"depth": 0}, "events": [recording]}
    return test.model_copy(update={"cursors": STRETCHES, "scenario": scenario})


def test_a_row_has_what_the_cursor_has(with_cursors):
    """Levels to three digits, times in ms, overshoot in percent; what is not told is a dash."""
    before, sag = cursor_parts(with_cursors, Texts())  # the stretch without a cursor is left out
    assert before.heading == "Before the disturbance, 0.080 s to 0.280 s"
    assert before.rows[0].cells == ("499.9", "500.1", "500.0", *"–" * 6)
    assert sag.heading == "From 0.300 s to 0.800 s"
    assert sag.in_words.startswith("At 0.300 s the recorded voltage of <deep>.csv takes the place of the source.")
    assert sag.rows[0] == (
        "positive-sequence voltage",
        "pu",
        ("0.400", "0.400", "0.400", "1.000 → 0.400", "2.1", "16.0", "18.1", "–", "1.2"),
    )
    assert len(sag.rows[0].cells) == len(COLUMNS)


@pytest.mark.parametrize("language", languages())
def test_every_language_has_all_words(language, with_cursors):
    """Headings and names of quantities come from the catalogue."""
    texts = Texts(language)
    assert len({heading.name for heading in headings(texts)}) == len(COLUMNS) + 1
    assert "±10 %" in note(with_cursors, texts)
    assert cursor_parts(with_cursors, texts)[1].rows[0].name == texts("cursor.quantity.voltage_positive_pu")


def test_the_page_has_the_table(with_cursors, make_results):
    """It stands in the section of its test, words of the disturbance escaped; a test without cursors has none."""
    page = html.render(make_results(with_cursors), {})
    assert page.count('<table class="cursors folds">') == 1
    assert "recorded voltage of &lt;deep&gt;.csv" in page
    assert "<td>1.000 → 0.400<" in page
    assert '<table class="cursors folds">' not in html.render(
        make_results(with_cursors.model_copy(update={"cursors": ()})), {}
    )
