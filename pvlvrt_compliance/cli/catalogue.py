"""`--list`: the selected tests as a table, or as JSON."""

from typing import Any

from pvlvrt_compliance.cli.tables import Column, print_table
from pvlvrt_compliance.cli.telling import say, say_json, tell
from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.selection import Assignment

_COLUMNS = (
    Column("test"),
    Column("what happens", folds=True),
    *(Column(heading, is_number=True) for heading in ("s", "W/m2", "deg", "Hz")),
    Column("confidence"),
)


def show_tests(job: Job, *, as_json: bool = False) -> int:
    """Print the selected tests; nothing is simulated."""
    for note in job.notes:
        tell(note)
    if as_json:
        say_json([_entry(item) for item in job.tests])
        return 0
    several = len(job.profiles) > 1
    columns = (Column("profile"), *_COLUMNS) if several else _COLUMNS
    rows = [((item.profile.id,) if several else ()) + _cells(item) for item in job.tests]
    print_table(columns, rows)
    names = ", ".join(profile.id for profile in job.profiles)
    say(f"{len(job.tests)} test{'' if len(job.tests) == 1 else 's'} of {names}")
    if job.left_out:
        say(f"{len(job.left_out)} more with --include-long")
    return 0


def _cells(item: Assignment) -> tuple[str, ...]:
    test, scenario = item.test, item.test.scenario
    return (
        test.id,
        scenario.describe(),
        f"{scenario.duration_s:.3f}",
        f"{scenario.irradiance_w_m2:g}",
        f"{scenario.point_on_wave_deg:g}",
        f"{scenario.frequency_hz:g}",
        test.confidence,
    )


def _entry(item: Assignment) -> dict[str, Any]:
    """A test for programs; keys are only added to."""
    profile, test, scenario = item.profile, item.test, item.test.scenario
    return {
        "profile": profile.id,
        "id": test.id,
        "row": test.row,
        "table_row": profile.row_of(test),
        "title": test.title,
        "what_happens": scenario.describe(),
        "duration_s": scenario.duration_s,
        "irradiance_w_m2": scenario.irradiance_w_m2,
        "point_on_wave_deg": scenario.point_on_wave_deg,
        "frequency_hz": scenario.frequency_hz,
        "checks": [kind for kind, _ in profile.requirements.by_kind() if test.judges(kind)],
        "expect": test.expect,
        "clause": test.clause,
        "confidence": test.confidence,
        "long": test.long,
    }
