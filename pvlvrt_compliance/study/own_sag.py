"""One sag of somebody's own, in place of the tests of profiles."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, get_args

from pvlvrt_compliance.data.models import made
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.scenario.sag import PAIRS, Sag, Type, near_phases
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.units import parse_duration, parse_fraction

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Asked

_PHASES = ("abc", "a", "b", "c", *PAIRS)
_TYPES = get_args(Type)


def sag_tests(
    profiles: tuple[Profile, ...],
    asked: "Asked",
    depth: str | float,
    fields: Mapping[str, Any],
    spell: Callable[[str], str],
) -> tuple[Assignment, ...]:
    """One test, the same for every profile: as long as the most demanding of them asks for.

    Parameters
    ----------
    profiles : tuple of Profile
    asked : Asked
        Describes the sag.
    depth : str or float
        Of it.
    fields : mapping
        Further fields of the scenario.
    spell : callable
        As of `make_job`.

    Raises
    ------
    UsageError
        When there is no such sag.
    """
    sag = _sag(asked, depth, spell)
    if asked.duration is not None:
        duration_s = parse_duration(as_typed(asked.duration, "s"), spell("duration"))
    else:
        duration_s = max(profile.sag_duration_s(sag) for profile in profiles)
    times = {
        "before_s": max(profile.procedure.before_s.value for profile in profiles),
        "after_s": max(profile.procedure.after_s.value for profile in profiles),
    }
    return tuple(
        Assignment(profile, profile.ad_hoc_test(sag, duration_s, **(times | dict(fields)))) for profile in profiles
    )


def as_typed(value: str | float, unit: str = "") -> str:
    """A value as the command takes it."""
    return value if isinstance(value, str) else f"{float(value)!r}{unit}"


def _sag(asked: "Asked", depth: str | float, spell: Callable[[str], str]) -> Sag:
    two_phase = asked.two_phase
    phases = ("bc" if two_phase else "abc") if asked.phases is None else asked.phases
    if phases not in _PHASES:
        known = f"{', '.join(_PHASES)}{near_phases(phases)}"
        raise UsageError(f"{spell('phases')} {phases}: unknown; allowed are {known}")
    if asked.sag_type is not None and (asked.sag_type not in _TYPES or two_phase or len(phases) == 2):
        allowed = f"{', '.join(_TYPES)}, with one phase or none, without {spell('two_phase')}"
        raise UsageError(f"{spell('sag_type')} {asked.sag_type}: allowed are {allowed}")
    if two_phase and phases not in PAIRS:
        raise UsageError(f"{spell('two_phase')}: a pair of phases is needed, {', '.join(PAIRS)}; not {phases!r}")
    fields = {
        "depth": parse_fraction(as_typed(depth), spell("sag")),
        "phases": phases,
        "two_phase": two_phase,
        "type": asked.sag_type,
    }
    return made(Sag, fields)
