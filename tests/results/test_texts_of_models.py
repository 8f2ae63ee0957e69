"""Every text that results and comparisons may hold is one that anybody may be shown, whoever has made the model."""

import typing
from types import UnionType

import pytest
from pydantic import BaseModel

import worst
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.comparison import Comparison
from pvlvrt_compliance.results.details import LOGO, ReportDetails
from pvlvrt_compliance.texts import Data, Id, Name, Plain, Text

_KEPT = {typing.get_args(each)[1:] for each in (Text, Name, Id, Plain, Data)}
_OTHERWISE = {(ReportDetails, "fields")}
"""Fields with a rule of their own, which has a test of its own."""


def texts_in(annotation, metadata=()):
    """Types within a type that could hold a text as it came."""
    origin, inner = typing.get_origin(annotation), typing.get_args(annotation)
    if tuple(metadata) in _KEPT or origin is typing.Literal:
        return
    if origin is typing.Annotated:
        yield from texts_in(inner[0], inner[1:])
    elif annotation in (str, typing.Any):
        yield annotation
    elif origin in (typing.Union, UnionType, tuple, list, dict):
        for each in inner:
            yield from texts_in(each)


def models(model, known):
    """A model and all that it is made of."""
    known.add(model)
    for field in model.model_fields.values():
        for each in models_in(field.annotation):
            if each not in known:
                models(each, known)
    return known


def models_in(annotation):
    """Models within a type."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for each in typing.get_args(annotation):
        yield from models_in(each)


ALL = sorted(models(Results, set()) | models(Comparison, set()), key=lambda model: model.__name__)


def test_models_are_found():
    """The tree is walked: a verdict lies three models deep, a stretch of a disturbance likewise."""
    assert {"Verdict", "Stretch", "BaselineNote", "Changed", "CursorStretch"} <= {model.__name__ for model in ALL}


@pytest.mark.parametrize("model", ALL, ids=lambda model: model.__name__)
def test_no_field_keeps_a_text_as_it_came(model):
    """A field that could hold a bare text is found here, before somebody's text is in it."""
    loose = {name for name, field in model.model_fields.items() if list(texts_in(field.annotation, field.metadata))}
    assert {(model, name) for name in loose} <= _OTHERWISE


def test_fields_of_a_title_page():
    """They are texts like any other; only the address of a logo may be long, and that has none of a text's dangers."""
    logo = f"data:image/png;base64,{'A' * 50_000}"
    fields = ReportDetails(fields={"client": worst.WORST, LOGO: logo, worst.WORST: "x"}).fields
    assert fields.pop(LOGO) == logo
    worst.data(fields)
    assert worst.MARK in fields["client"]
    worst.data(ReportDetails(fields={LOGO: f"data:image/png;base64,{worst.WORST}"}).fields)
