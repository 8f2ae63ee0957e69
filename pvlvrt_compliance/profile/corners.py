"""Rows of a test table made from regions: one test just inside each corner."""

from collections.abc import Iterator

from pvlvrt_compliance.data.marks import weakest
from pvlvrt_compliance.data.models import made
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.curves import Side
from pvlvrt_compliance.profile.procedure import TestRow
from pvlvrt_compliance.profile.regions import STAY_CONNECTED, LinearTime, Region, RegionTable
from pvlvrt_compliance.profile.sequences import CornerTests
from pvlvrt_compliance.scenario.events import LONGEST_S, VoltageProfile
from pvlvrt_compliance.scenario.sag import PhaseNames, Sag


def corner_rows(table: RegionTable, tests: CornerTests) -> Iterator[TestRow]:
    """A row for each corner of each region with a time to stay connected; sags for each choice of phases."""
    for region in table.rows:
        if region.mode in STAY_CONNECTED and region.ride_s is not None:
            side = table.side_of(region)
            for voltage_pu in _corners_pu(region, side, tests.inside_pu):
                for phases in tests.phases if side is Side.LOW else ("abc",):
                    yield _row(table, tests, region, voltage_pu, phases)


def _corners_pu(region: Region, side: Side, inside_pu: float) -> tuple[float, ...]:
    """Voltages to test: the far edge from nominal, and the near one, too, where the time grows with the voltage."""
    low, high = region.voltage_pu[0] + inside_pu, region.voltage_pu[1] - inside_pu
    if isinstance(region.ride_s, LinearTime):
        return low, high
    return (low,) if side is Side.LOW else (high,)


def _row(table: RegionTable, tests: CornerTests, region: Region, voltage_pu: float, phases: PhaseNames) -> TestRow:
    ride_s = region.ride_through_s(voltage_pu)
    duration_s = round(ride_s - tests.inside_s, 6)
    if not 0 < duration_s <= LONGEST_S:
        said = f"a test just inside {voltage_pu:g} pu would last {duration_s:g} s"
        raise UsageError(f"{said}; above 0 s and up to {LONGEST_S:g} s are allowed")
    swell = voltage_pu > 1
    where = "" if phases == "abc" else f"-{phases}"
    step = VoltageProfile(points=((0.0, 1.0), (0.0, voltage_pu), (duration_s, voltage_pu), (duration_s, 1.0)))
    fields = dict(
        id=f"{voltage_pu:.3f}pu-{ride_s:g}s{where}",
        title=f"{region.mode.replace('_', ' ')} at {voltage_pu:.3f} pu for {duration_s:g} s, phases {phases}",
        clause=tests.clause or table.clause,
        sag=Sag(depth=0) if swell else Sag(depth=round(1 - voltage_pu, 9), phases=phases),
        events=(step,) if swell else (),
        duration_s=duration_s,
        powers=tests.powers,
        checks=tests.checks,
        long=duration_s >= tests.long_from_s,
        confidence=weakest([tests.confidence, table.confidence]),
        source=f"{tests.source}; {table.source}",
    )
    return made(TestRow, fields)
