"""Texts of the report: each language says all that English does, with the same values in it."""

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report import language
from pvlvrt_compliance.report.language import BASE, Texts, catalogue, check_language, languages, places_in

OTHERS = [name for name in languages() if name != BASE]


def test_english_and_spanish_are_there():
    """The two that are promised."""
    assert {"en", "es"} <= set(languages())


@pytest.mark.parametrize("name", OTHERS)
def test_every_language_has_the_texts_of_the_base(name):
    """No text is missing, none is left over."""
    assert catalogue(name).keys() == catalogue(BASE).keys()


@pytest.mark.parametrize("name", OTHERS)
def test_every_text_has_the_same_places(name):
    """A value that English shows is not lost in another language."""
    for key, text in catalogue(name).items():
        assert places_in(text) == places_in(catalogue(BASE)[key]), key


def test_a_number_decides_the_form(monkeypatch):
    """One test, two tests; a text without a form for one has the other."""
    monkeypatch.setattr(language, "catalogue", lambda _: {"n": {"one": "{count} test", "other": "{count} tests"}})
    texts = Texts()
    assert [texts("n", count=count) for count in (0, 1, 2)] == ["0 tests", "1 test", "2 tests"]


def test_a_name_without_a_text_is_told_in_its_own_words():
    """A check of another package is not in the catalogue."""
    assert Texts().named("check", "my_own_check") == "my own check"


def test_braces_in_a_value_stay():
    """A user's text is not read as a text of ours."""
    assert language._filled("{name}!", {"name": "{count} & <b>"}) == "{count} & <b>!"


def test_an_unknown_language_names_the_known():
    """The message says what may be given."""
    with pytest.raises(UsageError, match="--language: no language 'de'; there are: en, es"):
        check_language("de")
