import json

from pvlvrt_compliance.checks.results import Check, Results, TestResult
from pvlvrt_compliance.report import results_json


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
    assert set(definitions["Check"]["properties"]) == set(Check.model_fields)
    found = json.loads(results_json.render(make_results(make_test())))["tests"][0]
    assert set(found) <= set(definitions["TestResult"]["properties"])
    assert set(found["measurements"]["during"]) <= set(definitions["WindowMeasurements"]["properties"])
