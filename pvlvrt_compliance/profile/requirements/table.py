"""The demands of a profile: an open table of requirements by kind."""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from pydantic import Field, create_model

from pvlvrt_compliance.data.marks import Frozen
from pvlvrt_compliance.profile.requirements import connection, current, power, quality
from pvlvrt_compliance.profile.requirements.base import CustomRequirement, Requirement

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
        return dict(self.by_kind()).get(kind)


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
