"""Read profiles, judge records that are there already, compare what was found."""

from os import PathLike, fspath
from typing import TYPE_CHECKING

from pvlvrt_compliance.api.given import File
from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.profile import loading
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import Results

if TYPE_CHECKING:
    from pvlvrt_compliance.results.comparison import Comparison
    from pvlvrt_compliance.scenario.scenario import Scenario
    from pvlvrt_compliance.units import Nominal
    from pvlvrt_compliance.waveforms import Waveforms


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
        CSV (column ``t_s``), COMTRADE (``.cfg``), or a record that is read already.
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


def compare(old: File | Results, new: File | Results, *, fail_on: str = "verdict") -> "Comparison":
    """Compare two runs: what ``pvlvrt-check compare`` does with results that are there already.

    Two controllers are compared by a `check` of each.

    Parameters
    ----------
    old, new : str, path or Results
        A `results.json`, a folder that holds one, or results.
    fail_on : str
        What is a regression, as of the command: ``"verdict"`` or ``"margin:5%"``; `comparison_status` goes by it.

    Returns
    -------
    Comparison
        Every verdict that has changed, and what the runs were made with that differs.

    Raises
    ------
    UsageError
        When there are no results, or ``fail_on`` is none of these.
    """
    from pvlvrt_compliance.results.comparison import compare as compare_results
    from pvlvrt_compliance.study.comparing import read_side

    runs = [one if isinstance(one, Results) else read_side(fspath(one)).results for one in (old, new)]
    names = ["results" if isinstance(one, Results) else fspath(one) for one in (old, new)]
    return compare_results(runs[0], runs[1], fail_on, names=(names[0], names[1]))
