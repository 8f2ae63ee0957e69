"""`pvlvrt-check profiles schema`."""

from pvlvrt_compliance.cli.telling import say_json


def schema() -> None:
    """Print the JSON Schema of a profile's file, for editors that complete and check TOML as it is written.

    An editor finds it by a first line such as: #:schema ./profile.schema.json

    Example: pvlvrt-check profiles schema > profile.schema.json
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.profile.schema import file_schema

    say_json(file_schema(INSTALLED_KINDS))
