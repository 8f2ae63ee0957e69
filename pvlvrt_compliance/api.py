"""The functions that the package exports: check controllers, judge records (docs/api.md)."""

import json
import logging
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import fields
from os import PathLike, fspath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.output import output_in, report_details
from pvlvrt_compliance.profile import loading
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.study.job import Asked, Factory, make_job

if TYPE_CHECKING:
    from pvlvrt_compliance.scenario.events import Event
    from pvlvrt_compliance.scenario.scenario import Scenario
    from pvlvrt_compliance.study.session import Progress
    from pvlvrt_compliance.units import Nominal
    from pvlvrt_compliance.waveforms import Waveforms

File = str | PathLike[str]
Value = float | int | bool | str

_LOG = logging.getLogger("pvlvrt_compliance")
_SPELLED = {"list_only": "Profile.tests()", "help": "docs/api.md"}  # what a message calls otherwise than its keyword


def load_profile(name_or_path: File) -> Profile:
    """Read a profile and everything it includes; requirements of installed packages are known, too.

    Parameters
    ----------
    name_or_path : str or path
        A name that ``pvlvrt-check profiles list`` shows, or a file: ends in ``.toml`` or has a path separator.

    Raises
    ------
    UsageError
        When no profile has that name; names the known ones.
    ProfileError
        When a file cannot be read or is not a valid profile; lists every problem with file, line and key.
    """
    return loading.load_profile(fspath(name_or_path), INSTALLED_KINDS)


def check(
    profiles: File | Profile | Sequence[File | Profile],
    *,
    controller: File | Factory | None = None,
    mapping: File | None = None,
    sag: str | float | None = None,
    phases: str | None = None,
    two_phase: bool = False,
    sag_type: str | None = None,
    duration: str | float | None = None,
    point_on_wave: float | None = None,
    irradiance: float | None = None,
    frequency: float | None = None,
    temperature: float | None = None,
    scr: float | None = None,
    xr: float | None = None,
    transformer: str | None = None,
    events: "File | Sequence[Event] | None" = None,
    settings: Mapping[str, Any] | Sequence[str] = (),
    fidelity: str | None = None,
    tests: str | Sequence[str] = (),
    include_long: bool = False,
    output: File | None = None,
    csv: bool = False,
    waveforms: str = "all",
    formats: str | Sequence[str] = (),
    language: str = "en",
    report_fields: Mapping[str, str] = MappingProxyType({}),
    allow_unjudged: bool = False,
    progress: "Progress | None" = None,
) -> Results:
    """Run the tests of profiles, or one sag of one's own, and judge them: what the command does.

    Prints nothing. Keywords mean what the command's options of the same name do.

    Parameters
    ----------
    profiles : str, path, Profile, or a sequence of them
        Names, files, or profiles that are loaded already.
    controller : str, class or function, optional
        The bundled one unless it is given: a specification as of ``--controller``, a class, or a function that makes a
        controller. What runs it, this process or one of its own, is in docs/api.md.
    mapping : str or path, optional
        File that ties the controller's ports to the plant.
    sag : str or float, optional
        Depth of one sag, in place of the profiles' tests: ``"90%"`` or 0.9.
    phases, two_phase, sag_type, duration, point_on_wave, irradiance : optional
        Of that sag: ``"abc"``; whether the line-to-line voltage of a pair sags; Bollen's type; s, or ``"500ms"``;
        degrees; W/m2.
    frequency, temperature, scr, xr, transformer : optional
        Of every test: Hz, degrees C, ratios, vector group.
    events : str, path or sequence of events, optional
        What happens besides.
    settings : mapping or sequence of str
        Parameters, ``{"controller.pr_integral_gain": 0.2}`` or ``["controller.pr_integral_gain=0.2"]``.
    fidelity : str, optional
        ``"averaged"`` or ``"switched"``.
    tests : str or sequence of str
        Patterns of the ids of the tests that are run; without, all.
    include_long : bool
        Whether tests of half an hour are run.
    output : str or path, optional
        Folder for the files that the command writes; without, none is written.
    csv, waveforms
        Of these: whether waveforms are CSV, too; which are kept, ``"all"``, ``"failed"`` or ``"none"``.
    formats : str or sequence of str
        Further reports: ``"pdf"``, which needs the extra of that name.
    language : str
        Of the reports: ``"en"`` or ``"es"``.
    report_fields : mapping
        Of their title page: `client`, `number`, `revision`, ....
    allow_unjudged : bool
        As of the command, for `exit_status`.
    progress : callable, optional
        Called before each test with its profile and id, the number of tests that are finished, and of all.

    Returns
    -------
    Results
        Everything that was found, in the order of the profiles. What could not be simulated or measured is a verdict
        with its reason; nothing is raised for it.

    Raises
    ------
    UsageError
        When something that is given cannot be used; nothing has been written then.
    ProfileError
        When a profile is not a valid one.
    OutputError
        When a file cannot be written; the finished tests are kept as the message says.
    """
    given: dict[str, Any] = {
        "profiles": _listed(profiles),
        "controller": fspath(controller) if isinstance(controller, PathLike) else controller,
        "mapping": None if mapping is None else fspath(mapping),
        "sag": sag,
        "phases": phases,
        "two_phase": two_phase,
        "sag_type": sag_type,
        "duration": duration,
        "point_on_wave": point_on_wave,
        "irradiance": irradiance,
        "frequency": frequency,
        "temperature": temperature,
        "scr": scr,
        "xr": xr,
        "transformer": transformer,
        "events": fspath(events) if isinstance(events, str | PathLike) else events,
        "settings": _assignments(settings),
        "fidelity": fidelity,
        "tests": (tests,) if isinstance(tests, str) else tuple(tests),
        "include_long": include_long,
        "waveforms": waveforms,
    }
    asked = Asked(**given)
    job = make_job(asked, _spell)
    from pvlvrt_compliance.study.running import run_job

    return run_job(
        job,
        command=_call("check", {**_told(asked), **({"allow_unjudged": True} if allow_unjudged else {})}),
        output=None
        if output is None
        else output_in(
            fspath(output),
            len(job.tests),
            csv=csv,
            spell=_spell,
            formats=(formats,) if isinstance(formats, str) else formats,
            details=report_details(language, report_fields, spell=_spell),
        ),
        allow_unjudged=allow_unjudged,
        watch=nullcontext(progress),
        tell=_LOG.info,
    )


def evaluate(
    profile: File | Profile,
    record: "File | Waveforms",
    *,
    test: "str | Scenario | None" = None,
    nominal: "Nominal | None" = None,
    available_power_kw: float | None = None,
) -> Results:
    """Judge a record, simulated or measured, by every requirement of a profile. Nothing is simulated.

    Parameters
    ----------
    profile : str, path or Profile
        What is demanded.
    record : str, path or Waveforms
        CSV (column ``t_s``), COMTRADE (``.cfg``; needs the extra ``comtrade``), or a record that is read already.
        Channels are named as docs/api.md has them, V and A.
    test : str or Scenario, optional
        What was applied: the id of one of the profile's tests, or a scenario, whose times count from the start of the
        record. Without, what the grid did is found from the record's voltages.
    nominal : Nominal, optional
        Base of the per-unit values; by default 500 kVA, 230 V, and the profile's frequency.
    available_power_kw : float, optional
        What the PV array could give before the disturbance; by default the rated power.

    Returns
    -------
    Results
        Of one test. What cannot be measured is `not_evaluated` with the reason; nothing is raised for it.

    Raises
    ------
    UsageError
        When the record cannot be read, or the profile has no such test.
    ProfileError
        When the profile is not a valid one.
    MeasurementError
        Without a test: when the record has no voltages, or nothing happens in it.
    """
    from pvlvrt_compliance.study.recorded import judge_recording

    found = profile if isinstance(profile, Profile) else load_profile(profile)
    return judge_recording(
        found,
        fspath(record) if isinstance(record, PathLike) else record,
        test=test,
        nominal=nominal,
        available_power_kw=available_power_kw,
    )


def _listed(given: "File | Profile | Sequence[File | Profile]") -> tuple[str | Profile, ...]:
    items = (given,) if isinstance(given, str | PathLike | Profile) else given
    return tuple(item if isinstance(item, Profile) else fspath(item) for item in items)


def _assignments(settings: Mapping[str, Any] | Sequence[str]) -> tuple[str, ...]:
    """Parameters as the command takes them."""
    if isinstance(settings, Mapping):
        return tuple(f"{name}={json.dumps(value)}" for name, value in settings.items())
    return (settings,) if isinstance(settings, str) else tuple(settings)


def _spell(name: str) -> str:
    return _SPELLED.get(name, name)


def _told(asked: Asked) -> dict[str, Any]:
    """What was asked for, without what is as it is unless it is given."""
    return {
        field.name: getattr(asked, field.name) for field in fields(asked) if getattr(asked, field.name) != field.default
    }


def _call(function: str, given: Mapping[str, Any]) -> str:
    """The call that makes a run again, as it is written in Python."""
    words = ", ".join(f"{name}={_written(value)}" for name, value in given.items())
    return f"pvlvrt_compliance.{function}({words})"


def _written(value: Any) -> str:
    if isinstance(value, Profile):
        return repr(value.id)
    if isinstance(value, tuple):
        return f"[{', '.join(map(_written, value))}]"
    made: Callable[..., Any] | None = value if callable(value) else None
    return repr(value) if made is None else str(getattr(made, "__qualname__", type(made).__name__))
