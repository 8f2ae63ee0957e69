import json
import xml.etree.ElementTree as ET

import lxml.html
import pytest

from pvlvrt_compliance.report.formats import html, junit, results_json
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict, conclude


def test_reading_it_back_gives_the_same_results(make_test, make_results):
    """Nothing is lost between the results and the file."""
    results = make_results(make_test(), make_test("other"))
    assert Results.model_validate_json(results_json.render(results)) == results


def test_keys_stand_in_the_order_of_the_model(make_test, make_results):
    """The file reads from the general to the particular, ends with a newline, and is the same every time."""
    results = make_results(make_test())
    text = results_json.render(results)
    assert list(json.loads(text)) == list(Results.model_fields)
    assert list(json.loads(text)["tests"][0]) == list(TestResult.model_fields)
    assert text.endswith("}\n")
    assert text == results_json.render(results)


def test_schema_names_every_key(make_test, make_results):
    """The published schema describes all keys that a file has, down to the measurements."""
    schema = json.loads(results_json.schema())
    assert schema["$schema"].endswith("2020-12/schema")
    assert set(schema["properties"]) == set(Results.model_fields)
    definitions = schema["$defs"]
    assert set(definitions["Verdict"]["properties"]) == {*Verdict.model_fields, *Verdict.model_computed_fields}
    found = json.loads(results_json.render(make_results(make_test())))["tests"][0]
    assert set(found["checks"][0]) == set(definitions["Verdict"]["properties"])
    assert set(found) <= set(definitions["TestResult"]["properties"])
    assert set(found["measurements"]["during"]) <= set(definitions["WindowMeasurements"]["properties"])


def test_id_of_a_run_is_in_all_its_files(make_test, make_results):
    """A reader can tell whether they are of one run."""
    results = make_results(make_test(), make_test("other"))
    assert len(results.run_id) == 16
    assert json.loads(results_json.render(results))["run_id"] == results.run_id
    suites = ET.fromstring(junit.render(results)).findall("testsuite")
    ids = [suite.find("properties/property[@name='run_id']").get("value") for suite in suites]
    assert ids == [results.run_id] * 2
    page = lxml.html.document_fromstring(html.render(results, {}))
    assert page.xpath("//meta[@name='run-id']/@content") == [results.run_id]
    assert page.xpath("//dl[@class='run']/div[dt='run']/dd/code/text()") == [results.run_id]


def test_id_of_a_run_is_what_it_found_not_when(make_test, make_results):
    """Another time, or another way to ask, is the same run."""
    results = make_results(make_test())
    for key in ("created", "command"):
        assert conclude(results.tests, results.profiles, results.provenance | {key: "other"}).run_id == results.run_id
    assert make_results(make_test()).run_id == results.run_id


@pytest.mark.parametrize(
    "fields", [{"title": "other"}, {"reactive": Status.FAIL}, {"waveforms": None}, {"duration_s": 2.0}], ids=str
)
def test_runs_that_differ_have_different_ids(make_test, make_results, fields):
    """In whatever they found."""
    assert make_results(make_test(**fields)).run_id != make_results(make_test()).run_id


@pytest.mark.parametrize("key", ["parameters", "versions", "controller_digest"])
def test_runs_of_another_kind_have_different_ids(make_test, make_results, key):
    """Or in what was run."""
    results = make_results(make_test())
    other = conclude(results.tests, results.profiles, results.provenance | {key: {"other": 1}})
    assert other.run_id != results.run_id
