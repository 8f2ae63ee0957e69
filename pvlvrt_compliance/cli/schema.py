"""`pvlvrt-check schema`: the JSON Schema of results.json."""

from pvlvrt_compliance.cli.telling import hand_over


def schema() -> None:
    """Print the JSON Schema of results.json.

    Example: pvlvrt-check schema > results.schema.json
    """
    from pvlvrt_compliance.report.formats.results_json import schema as schema_text

    hand_over(schema_text())
