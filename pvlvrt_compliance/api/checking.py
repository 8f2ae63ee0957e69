"""Check controllers: what the command does."""

import logging
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from os import PathLike, fspath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.api.given import File, assignments, call, listed, spell, texts, told
from pvlvrt_compliance.output import output_in, report_details
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.study.job import Asked, Given, make_job

if TYPE_CHECKING:
    from pvlvrt_compliance.scenario.events import Event
    from pvlvrt_compliance.study.session import Progress

_LOG = logging.getLogger("pvlvrt_compliance")


def check(
    profiles: File | Profile | Sequence[File | Profile],
    *,
    controller: File | Given | None = None,
    mapping: File | None = None,
    sag: str | float | None = None,
    phases: str | None = None,
    two_phase: bool = False,
    sag_type: str | None = None,
    duration: str | float | None = None,
    point_on_wave: str | float | None = None,
    irradiance: str | float | None = None,
    frequency: str | float | None = None,
    temperature: str | float | None = None,
    scr: str | float | None = None,
    xr: str | float | None = None,
    transformer: str | None = None,
    events: "File | Sequence[Event] | None" = None,
    recordings: File | None = None,
    settings: Mapping[str, Any] | Sequence[str] = (),
    allow_out_of_range: bool = False,
    fidelity: str | None = None,
    tests: str | Sequence[str] = (),
    skip: str | Sequence[str] = (),
    checks: str | Sequence[str] = (),
    last_failed: bool = False,
    failed_first: bool = False,
    fail_fast: bool = False,
    include_long: bool = False,
    output: File | None = None,
    csv: bool = False,
    waveforms: str = "all",
    formats: str | Sequence[str] = (),
    language: str = "en",
    report_fields: Mapping[str, str] = MappingProxyType({}),
    baseline: File | None = None,
    baseline_tolerance: str | float | None = None,
    reuse: File | None = None,
    reuse_size: str | float | None = None,
    settle_once: bool = False,
    allow_unjudged: bool = False,
    jobs: int | str | None = None,
    cluster: str | None = None,
    debug: bool = False,
    progress: "Progress | None" = None,
) -> Results:
    """Run the tests of profiles, or one sag of one's own, and judge them: what the command does.

    Prints nothing. Keywords mean what the command's options of the same name do.

    Parameters
    ----------
    profiles : str, path, Profile, or a sequence of them
        Names, files, or profiles that are loaded already.
    controller : str, class, function or object, optional
        The bundled one unless it is given: a specification as of ``--controller`` (``"bundled"`` is that one, too), a
        class, a function that makes a controller, or one that is made already, of which each test has a copy. What runs
        it, this process or one of its own, is in docs/api.md.
    mapping : str or path, optional
        File that ties the controller's ports to the plant.
    sag : str or float, optional
        Depth of one sag, in place of the profiles' tests: ``"90%"`` or 0.9.
    phases, two_phase, sag_type, duration, point_on_wave, irradiance : optional
        Of that sag: ``"abc"``; whether the line-to-line voltage of a pair sags; Bollen's type; s, or ``"500ms"``;
        degrees, or ``"90deg"``; W/m2, or ``"0.8kW/m2"``.
    frequency, temperature, scr, xr, transformer : optional
        Of every test: Hz, or ``"50Hz"``; degrees C, or ``"45C"``; ratios; vector group.
    events : str, path or sequence of events, optional
        What happens besides.
    recordings : str or path, optional
        Folder that recordings may lie in besides that of the file that names them.
    settings : mapping or sequence of str
        Parameters, ``{"controller.pr_integral_gain": 0.2}`` or ``["controller.pr_integral_gain=0.2"]``.
    allow_out_of_range : bool
        Whether parameters of a controller of one's own may be out of the ranges that it states; the results name each.
    fidelity : str, optional
        ``"averaged"`` or ``"switched"``.
    tests, skip : str or sequence of str
        Patterns of the ids of the tests that are run, or of their rows; without, all. Of those that are not.
    checks : str or sequence of str
        Names of the checks that are judged; without, all.
    last_failed, failed_first : bool
        Whether only tests are run that the last run into ``output`` did not pass, or whether these are run first.
    fail_fast : bool
        Whether the run ends at the first test that is not passed.
    include_long : bool
        Whether tests of half an hour are run.
    output : str or path, optional
        Folder for the files that the command writes; without, none is written.
    csv, waveforms
        Of these: whether waveforms are CSV, too; which are kept, ``"all"``, ``"failed"`` or ``"none"``.
    formats : str or sequence of str
        Further reports, by the names that ``--format`` takes; ``"pdf"`` needs the extra of that name.
    language : str
        Of the reports: ``"en"`` or ``"es"``.
    report_fields : mapping
        Of their title page: `client`, `number`, `revision`, ....
    baseline : str or path, optional
        File of known failures, as ``pvlvrt-check baseline update`` writes it: `exit_status` is then 0 unless something
        is worse than it says.
    baseline_tolerance : str or float, optional
        By what share of the limit a margin may be lost, ``"1%"`` (the default) or 0.01.
    reuse : str or path, optional
        Folder of stored records: what is there, and of which nothing has changed, is not simulated again.
    reuse_size : str or float, optional
        What they may take: ``"2GB"``, or in GB; by default 10.
    settle_once : bool
        Whether tests that start from the same settled state go on from one, which is simulated once. The results are
        the same; a controller that does not allow it says so in its notes.
    allow_unjudged : bool
        As of the command, for `exit_status`.
    jobs : int or str, optional
        How many tests are run at once, each in a process of its own, ``"auto"`` for as many as there are cores; 1 is
        one after the other on one core. By default, in this process, with the next record made while one is judged. The
        results are the same; nothing of your program is imported or run in those processes but the controller and what
        its profiles need.
    cluster : str, optional
        Address of a dask scheduler, whose workers run the tests; or ``"local"``, which starts one here with as many
        workers as `jobs` says (put the call under ``if __name__ == "__main__":``). Needs the extra of that name.
    debug : bool
        Whether a controller by its specification, too, runs in this process, without limits and one test after the
        other: breakpoints hold there.
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
    LostError
        When the scheduler of a cluster is gone, or all its workers are; likewise.
    """
    given: dict[str, Any] = {
        "profiles": listed(profiles),
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
        "recordings": None if recordings is None else fspath(recordings),
        "settings": assignments(settings),
        "allow_out_of_range": allow_out_of_range,
        "fidelity": fidelity,
        "tests": texts(tests),
        "skip": texts(skip),
        "checks": texts(checks),
        "last_failed": last_failed,
        "failed_first": failed_first,
        "fail_fast": fail_fast,
        "include_long": include_long,
        "waveforms": waveforms,
        "baseline": None if baseline is None else fspath(baseline),
        "baseline_tolerance": baseline_tolerance,
        "jobs": jobs,
        "reuse": None if reuse is None else fspath(reuse),
        "reuse_size": reuse_size,
        "settle_once": settle_once,
        "cluster": cluster,
        "debug": debug,
    }
    asked = Asked(**given)
    job = make_job(asked, spell, last_run=None if output is None else fspath(output))
    from pvlvrt_compliance.study.running import run_job

    return run_job(
        job,
        command=call("check", {**told(asked), **({"allow_unjudged": True} if allow_unjudged else {})}),
        output=None
        if output is None
        else output_in(
            fspath(output),
            len(job.tests),
            csv=csv,
            spell=spell,
            formats=texts(formats),
            details=report_details(language, report_fields, spell=spell),
        ),
        allow_unjudged=allow_unjudged,
        watch=nullcontext(progress),
        tell=_LOG.info,
    )
