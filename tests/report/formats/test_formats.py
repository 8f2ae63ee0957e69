"""The files of a run: one module each, found by being there."""

import sys

import pytest

from pvlvrt_compliance.report import formats
from pvlvrt_compliance.results.files import ON_REQUEST, SHARD
from pvlvrt_compliance.study import store


@pytest.fixture
def one_more(tmp_path, monkeypatch):
    """A further module in the folder of the formats."""
    text = "FILE = 'verdict.txt'\n\n\ndef render(results, drawings):\n    return f'{results.status} {len(drawings)}'\n"
    (tmp_path / "verdict.py").write_text(text, "utf-8")
    monkeypatch.setattr(formats, "__path__", [*formats.__path__, str(tmp_path)])
    yield
    sys.modules.pop(f"{formats.__name__}.verdict", None)


def test_the_files_of_a_run():
    """Each has a name of its own, and the output folder knows them all, besides what a part of a run is merged by."""
    files = [form.file for form in formats.formats()]
    assert sorted([*files, SHARD]) == sorted({store.REPORT, store.JUNIT, store.RESULTS, *ON_REQUEST})


def test_what_is_asked_for_by_name_is_not_always_written():
    """A run without options needs no library besides the core."""
    always = {store.REPORT, store.JUNIT, store.RESULTS}
    assert {form.file for form in formats.chosen_formats(())} == always
    for form in formats.formats():
        assert {each.file for each in formats.chosen_formats((form.name,))} == always | {form.file}


def test_each_makes_text_or_bytes_of_results_and_drawings(make_test, make_results, make_drawing):
    """All are called alike."""
    test = make_test()
    for form in formats.formats():
        assert isinstance(form.render(make_results(test), {test.key: make_drawing(test)}), str | bytes)


@pytest.mark.usefixtures("one_more")
def test_a_module_that_is_put_there_is_a_format(make_test, make_results):
    """A new format is one file: nothing else has to name it."""
    form = next(form for form in formats.formats() if form.file == "verdict.txt")
    assert form.render(make_results(make_test()), {}) == "pass 0"
