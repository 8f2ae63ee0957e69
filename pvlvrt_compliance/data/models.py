"""A table held against the model of its kind of file."""

import json
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.problems import dotted, problem_lines
from pvlvrt_compliance.errors import UsageError

Model = TypeVar("Model", bound=BaseModel)


def validated(model: type[Model], table: dict[str, Any]) -> tuple[Model | None, list[tuple[Location, str]]]:
    """The table as a model, or None and location and text of every problem.

    Numbers, texts and flags are not made from one another: ``"5"`` is no number, ``1`` no flag.
    """
    try:
        # Strict JSON mode is strict about numbers and texts, yet takes a list for a tuple.
        return model.model_validate_json(json.dumps(table, default=str), strict=True), []
    except ValidationError as error:
        return None, problem_lines(error, model, table)


def made(model: type[Model], fields: dict[str, Any]) -> Model:
    """A model of fields that are made from what has been read.

    Raises
    ------
    UsageError
        When one is unknown or out of its range; ``field: what is wrong`` of each.
    """
    try:
        return model.model_validate(fields)
    except ValidationError as error:
        problems = (f"{dotted(location)}: {text}" for location, text in problem_lines(error, model))
        raise UsageError("; ".join(problems)) from None
