"""Kinds of requirements that can be judged here: reading a profile loads no check for those of this package."""

from collections.abc import Iterator, Mapping

from pvlvrt_compliance.profile.requirements import BUILT_IN, Kinds, Requirement


class InstalledKinds(Mapping[str, type[Requirement]]):
    """Models of all kinds that can be judged, for `load_profile`; packages are asked only beyond the built-in ones."""

    def __getitem__(self, kind: str) -> type[Requirement]:
        return BUILT_IN[kind] if kind in BUILT_IN else _of_other_packages()[kind]

    def __iter__(self) -> Iterator[str]:
        return iter([*BUILT_IN, *_of_other_packages()])

    def __len__(self) -> int:
        return len(BUILT_IN) + len(_of_other_packages())


INSTALLED_KINDS: Kinds = InstalledKinds()


def _of_other_packages() -> dict[str, type[Requirement]]:
    from pvlvrt_compliance.checks.registry import kinds_of_other_packages

    return kinds_of_other_packages()
