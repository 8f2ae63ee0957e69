"""The demands of a profile: an open table of requirements by kind."""

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any, TypeVar, get_args

from pydantic import Field, create_model

from pvlvrt_compliance.data.marks import Frozen
from pvlvrt_compliance.profile.requirements import connection, current, power, quality
from pvlvrt_compliance.profile.requirements.base import CustomRequirement, Requirement

Model = TypeVar("Model")

Kinds = Mapping[str, type[Requirement]]
"""Model of each kind of requirement that a profile may have, in the order of a report."""

BUILT_IN: Kinds = {
    kind: model
    for room in (connection, current, power, quality)
    for model in vars(room).values()
    if isinstance(model, type) and issubclass(model, Requirement)
    for kind in model.kinds
}
"""The kinds of this package, in the order in which their models are defined."""


class Requirements(Frozen):
    """The demands of a profile by kind; a kind that is left out is not judged.

    Which kinds there are is for `requirements_of` to say: each is an attribute of the same name, None where the profile
    makes no such demand.
    """

    custom: dict[str, CustomRequirement] = Field(default_factory=dict)

    def by_kind(self) -> Iterator[tuple[str, Any]]:
        """Each demand that the profile makes, with its kind, in the order of a report."""
        for kind in type(self).model_fields:
            if kind != "custom" and (requirement := getattr(self, kind)) is not None:
                yield kind, requirement
        yield from self.custom.items()

    def of_kind(self, kind: str) -> Any:
        """The demand of one kind, None where the profile makes none."""
        if kind in self.custom:
            return self.custom[kind]
        return getattr(self, kind) if kind != "custom" and kind in type(self).model_fields else None

    def __reduce__(self) -> tuple[Any, ...]:
        """For another process, which has no such class by its name, but can make it of the kinds."""
        return unfilled, (requirements_of, kinds_of(type(self))), self.__getstate__()


def kinds_of(model: type[Requirements]) -> dict[str, type[Requirement]]:
    """The kinds that a model of demands was made with, as of `requirements_of`."""
    fields = {name: get_args(info.annotation) for name, info in model.model_fields.items() if name != "custom"}
    return {kind: demand for kind, (demand, _) in fields.items()}


def unfilled(model_of: Callable[[Kinds], type[Model]], kinds: Kinds) -> Model:
    """An object of a model that is made of kinds, without its values: what `pickle` begins with."""
    model = model_of(kinds)
    return model.__new__(model)


def requirements_of(kinds: Kinds) -> type[Requirements]:
    """Model of the demands of a profile that may have these kinds."""
    return _model(tuple(kinds.items()))


@cache
def _model(kinds: tuple[tuple[str, type[Requirement]], ...]) -> type[Requirements]:
    fields: dict[str, Any] = {kind: (model | None, None) for kind, model in kinds}
    made: type[Requirements] = create_model(
        "Requirements", __base__=Requirements, __doc__=Requirements.__doc__, __module__=__name__, **fields
    )
    return made
