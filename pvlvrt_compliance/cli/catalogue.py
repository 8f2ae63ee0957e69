"""`--list`: the selected tests as a table."""

from rich import box
from rich.console import Console
from rich.table import Table

from pvlvrt_compliance.study.job import Job


def show_tests(job: Job) -> int:
    """Print the selected tests; nothing is simulated."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    several = len(job.profiles) > 1
    for heading in (*(["profile"] if several else []), "test", "what happens"):
        table.add_column(heading, no_wrap=True)
    for heading in ("s", "W/m2", "deg", "Hz"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("confidence", no_wrap=True)
    for profile, test in job.tests:
        scenario = test.scenario
        table.add_row(
            *([profile.id] if several else []),
            test.id,
            scenario.describe(),
            f"{scenario.duration_s:.3f}",
            f"{scenario.irradiance_w_m2:g}",
            f"{scenario.point_on_wave_deg:g}",
            f"{scenario.frequency_hz:g}",
            test.confidence,
        )
    console = Console()
    console.print(table)
    names = ", ".join(profile.id for profile in job.profiles)
    console.print(f"{len(job.tests)} test{'' if len(job.tests) == 1 else 's'} of {names}", highlight=False)
    if job.left_out:
        console.print(f"{len(job.left_out)} more with --include-long", highlight=False)
    return 0
