"""What is to be run: what somebody asks for, checked and turned into tests and parameters.

Nothing is written or simulated here.
"""

import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from pvlvrt_compliance.controllers import Controller
from pvlvrt_compliance.controllers.bundled import BUNDLED
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results.baseline import TOLERANCE
from pvlvrt_compliance.scenario.events import Event
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study import at_once, from_asked
from pvlvrt_compliance.study.baseline.applying import Held
from pvlvrt_compliance.study.baseline.reading import read_baseline
from pvlvrt_compliance.study.choosing import choose
from pvlvrt_compliance.study.cost import refuse_costly
from pvlvrt_compliance.study.from_asked import named_by_file, parameters_of, profiles_of, spelled_field, tests_of
from pvlvrt_compliance.study.idle import idle
from pvlvrt_compliance.study.played import with_recordings
from pvlvrt_compliance.study.reuse.opening import limit_of
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.settling import settles_once
from pvlvrt_compliance.study.shards.shard import Shard, shard_of
from pvlvrt_compliance.units import parse_fraction

ALL = from_asked.ALL
Spell = from_asked.Spell
AUTO, LOCAL = at_once.AUTO, at_once.LOCAL

KEEP_ALL, KEEP_FAILED, KEEP_NONE = "all", "failed", "none"
WAVEFORMS_KEPT = (KEEP_ALL, KEEP_FAILED, KEEP_NONE)

HOW = ("jobs", "cluster", "debug", "settle_once")
"""Fields of `Asked` that say how tests are run: what is found is the same."""

Given = Callable[..., Any] | Controller
"""A controller's class, a function that makes one, or one that is made already."""

_SAG_FIELDS = ("phases", "two_phase", "sag_type", "duration", "point_on_wave", "irradiance")
"""Fields that describe a sag of one's own."""

_OF_PROFILES = ("tests", "skip", "last_failed", "failed_first")
"""Fields that select from the tests of profiles."""

_OF_OTHERS = ("fail_fast", "last_failed", "failed_first")
"""Fields by which a test is run, or not, for what has become of others."""


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What somebody asks for, as he has given it; the command has an option for each.

    Parameters
    ----------
    profiles : sequence of str or Profile
        Names, files, `ALL`, or profiles that are loaded already.
    controller : str, class, function or object, optional
        A controller of one's own: its specification (``my_ctrl.py:MyController``), or in Python itself; `BUNDLED` is
        none, as without.
    mapping : str, optional
        File that ties its ports to the plant.
    sag : str or float, optional
        Depth of a sag of one's own (``90%`` or 0.9), in place of the profiles' tests.
    phases, two_phase, sag_type, duration, point_on_wave, irradiance : optional
        Of that sag: what `scenario.sag.Sag` and `Scenario` have; with units (``500ms``, ``90deg``, ``800W/m2``) or
        in s, degrees, W/m2.
    frequency, temperature, scr, xr, transformer : optional
        Of every test: ``50Hz`` or Hz, ``45C`` or degrees C, a ratio, a ratio, a vector group.
    events, recordings : optional
        What happens besides, a file or the events; a folder that recordings may lie in besides that of such a file.
    settings : sequence of str
        Parameters, ``controller.pr_integral_gain=0.2``.
    allow_out_of_range : bool
        Whether those of a controller of one's own may be out of the ranges that it states; the results name each.
    fidelity : str, optional
        Of the inverter.
    tests, skip : sequence of str
        Patterns of the ids of tests, or of their rows: those that are run, and those of them that are not.
    checks : sequence of str
        Names of the checks that are judged; without, all.
    last_failed, failed_first : bool
        Whether only tests are run that were not passed the last time, or whether these are run first.
    fail_fast, include_long : bool
        Whether the run ends at the first test that is not passed, and whether tests of half an hour are run.
    waveforms : str
        Which are kept, of `WAVEFORMS_KEPT`.
    baseline : str, optional
        File of known failures.
    baseline_tolerance : str or float, optional
        By what share a margin may be lost against it, ``1%`` or 0.01; by default `TOLERANCE`.
    shard : str, optional
        Which part of the tests is run, and of how many: ``2/5``.
    jobs : str or int, optional
        How many tests are run at once, each in a process of its own, or `AUTO`; 1 is one after the other on one core.
        None: in this process, where a record is made while another is judged.
    reuse, reuse_size : optional
        Folder of stored records, of which none is simulated again, and what they may take: ``2GB``, or in GB.
    settle_once : bool
        Whether tests that start from the same settled state go on from one, which is simulated once.
    cluster : str, optional
        Address of a dask scheduler whose workers run the tests, or `LOCAL`: one that is started on this machine, with
        as many workers as ``jobs`` says.
    debug : bool
        Whether the controller runs in this process, for a debugger or a sanitiser, one test after the other.
    """

    profiles: Sequence[str | Profile] = ()
    controller: str | Given | None = None
    mapping: str | None = None
    sag: str | float | None = None
    phases: str | None = None
    two_phase: bool = False
    sag_type: str | None = None
    duration: str | float | None = None
    point_on_wave: str | float | None = None
    irradiance: str | float | None = None
    frequency: str | float | None = None
    temperature: str | float | None = None
    scr: str | float | None = None
    xr: str | float | None = None
    transformer: str | None = None
    events: str | Sequence[Event] | None = None
    recordings: str | None = None
    settings: Sequence[str] = ()
    allow_out_of_range: bool = False
    fidelity: str | None = None
    tests: Sequence[str] = ()
    skip: Sequence[str] = ()
    checks: Sequence[str] = ()
    last_failed: bool = False
    failed_first: bool = False
    fail_fast: bool = False
    include_long: bool = False
    waveforms: str = KEEP_ALL
    baseline: str | None = None
    baseline_tolerance: str | float | None = None
    shard: str | None = None
    jobs: str | int | None = None
    reuse: str | None = None
    reuse_size: str | float | None = None
    settle_once: bool = False
    cluster: str | None = None
    debug: bool = False


@dataclass(frozen=True, kw_only=True)
class Job:
    """What is to be run."""

    profiles: tuple[Profile, ...]
    tests: tuple[Assignment, ...]
    left_out: tuple[Assignment, ...] = ()  # long tests that nobody asked for
    not_selected: tuple[Assignment, ...] = ()  # all other tests of the profiles
    first: Collection[str] = ()  # keys of those that are run before the others
    checks: Sequence[str] = ()  # those that are judged; none: all
    fail_fast: bool = False  # whether the run ends at the first test that is not passed
    notes: Sequence[str] = ()  # what there is to know of the selection
    parameters: Parameters
    controller: str | Given | None = None  # of the user's own
    given: Mapping[str, float | int | bool | str]  # its parameters, as far as they are set
    allow_out_of_range: bool = False  # whether they may be out of the ranges that it states
    mapping: str | None = None  # file that ties its ports to the plant
    waveforms: str = KEEP_ALL
    profile_files: Mapping[str, str] = field(default_factory=dict)  # by id, as far as they were named by their file
    baseline: Held | None = None  # what is known, read before anything is run
    shard: Shard | None = None  # which part of the run it is
    size: int = 0  # how many tests the whole run has; of a part, that which it is of
    jobs: str | int | None = None  # as of `Asked`, checked
    reuse: str | None = None  # folder of stored records
    reuse_bytes: int = 0  # what these may take
    settle_once: bool = False  # whether tests go on from settled states
    cluster: str | None = None
    debug: bool = False  # whether the controller runs in this process, to be looked at
    made_ns: int = field(default_factory=time.time_ns)  # when this was made: records that were used since then stay

    @property
    def is_elsewhere(self) -> bool:
        """Whether tests are to be run in processes of their own, or on other machines."""
        return self.cluster is not None or self.jobs not in (None, 1)


def make_job(asked: Asked, spell: Spell = str, *, last_run: str | None = None, is_simulated: bool = True) -> Job:
    """Check everything that can be checked before the first simulation.

    Parameters
    ----------
    asked : Asked
        What somebody asks for.
    spell : callable
        How a message names a field of it.
    last_run : str, optional
        Folder of the files of the last run, which says what was not passed then.
    is_simulated : bool
        Whether anything will be: recordings that are played back are read then.

    Raises
    ------
    PvlvrtError
        When a profile, a value or the selection cannot be used.
    """
    if asked.controller == BUNDLED:
        asked = replace(asked, controller=None)
    _check_together(asked, spell)
    profiles = profiles_of(asked.profiles, spell)
    parameters, given = parameters_of(asked, spell)
    try:
        everything = tests_of(profiles, asked, spell)
    except UsageError as error:
        field, colon, rest = str(error).partition(":")
        raise UsageError(spelled_field(field, spell) + colon + rest) from None
    choice = choose(everything, profiles, asked, spell, last_run)
    if not choice.tests:
        names = ", ".join(profile.id for profile in profiles)
        raise UsageError(f"{names}: the profile has no tests of its own; give one, for instance {spell('sag')} 90%")
    refuse_costly(choice.tests, parameters)
    shard, tests, elsewhere = _part(asked, choice.tests, spell)
    return Job(
        profiles=profiles,
        tests=with_recordings(tests, asked.recordings, spell, are_read=is_simulated),
        left_out=choice.left_out,
        not_selected=(*choice.not_selected, *elsewhere),
        shard=shard,
        size=len(choice.tests),
        first=choice.first,
        checks=asked.checks,
        fail_fast=asked.fail_fast,
        notes=(*choice.notes, *idle(asked, parameters, choice.tests, spell)),
        parameters=parameters,
        controller=asked.controller,
        given=given,
        allow_out_of_range=asked.allow_out_of_range,
        mapping=asked.mapping,
        waveforms=asked.waveforms,
        profile_files=named_by_file(asked.profiles, profiles),
        baseline=_baseline(asked, spell),
        jobs=at_once.jobs_of(asked, spell),
        reuse=asked.reuse,
        reuse_bytes=limit_of(asked, spell),
        settle_once=settles_once(asked, spell),
        cluster=at_once.cluster_of(asked, spell),
        debug=asked.debug,
    )


def _check_together(asked: Asked, spell: Spell) -> None:
    """Refuse what does not go together, and what is none of a few words."""
    if asked.sag is None and any(_is_given(getattr(asked, name)) for name in _SAG_FIELDS):
        *others, last = map(spell, _SAG_FIELDS)
        raise UsageError(f"{', '.join(others)} and {last} need {spell('sag')}")
    if asked.sag is not None and (given := next((name for name in _OF_PROFILES if getattr(asked, name)), None)):
        own = "selects from the profile's own tests; it does not go with"
        raise UsageError(f"{spell(given)} {own} {spell('sag')}")
    if asked.mapping is not None and asked.controller is None:
        own = "is for the ports of a controller of your own; it needs"
        raise UsageError(f"{spell('mapping')} {own} {spell('controller')}")
    if asked.debug and asked.controller is None:
        own = "is for a controller of your own; it needs"
        raise UsageError(f"{spell('debug')} {own} {spell('controller')}")
    if asked.mapping is not None and not isinstance(asked.controller, str):
        raise UsageError(f"{spell('mapping')}: a Python class takes its measurements by their names, without a file")
    if asked.shard is not None and (given := next((name for name in _OF_OTHERS if getattr(asked, name)), None)):
        said = "goes by what other tests have come to, of which some are in other parts; it does not go with"
        raise UsageError(f"{spell(given)} {said} {spell('shard')}")
    if asked.waveforms not in WAVEFORMS_KEPT:
        raise UsageError(f"{spell('waveforms')} {asked.waveforms}: allowed are {', '.join(WAVEFORMS_KEPT)}")


def _baseline(asked: Asked, spell: Spell) -> Held | None:
    if asked.baseline is None:
        if asked.baseline_tolerance is not None:
            raise UsageError(f"{spell('baseline_tolerance')} needs {spell('baseline')}")
        return None
    given = TOLERANCE if asked.baseline_tolerance is None else asked.baseline_tolerance
    tolerance = parse_fraction(str(given), spell("baseline_tolerance"))
    return Held(read_baseline(asked.baseline, spell("baseline")), tolerance)


def _part(
    asked: Asked, tests: tuple[Assignment, ...], spell: Spell
) -> tuple[Shard | None, tuple[Assignment, ...], tuple[Assignment, ...]]:
    """The part that is asked for, if one is, its tests, and those of the others."""
    if asked.shard is None:
        return None, tests, ()
    from pvlvrt_compliance.study.shards.dividing import tests_in  # which knows what jobs are

    shard = shard_of(asked.shard, spell("shard"))
    chosen = tests_in(shard, tests, spell("shard"))
    keys = {item.key for item in chosen}
    return shard, chosen, tuple(item for item in tests if item.key not in keys)


def _is_given(value: object) -> bool:
    return value is not None and value is not False
