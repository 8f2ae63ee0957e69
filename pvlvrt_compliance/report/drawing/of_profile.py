"""What can be drawn of a profile: its limits over time and its demands over the voltage, as lines and areas."""

from collections.abc import Iterator
from itertools import pairwise

from pvlvrt_compliance.data.marks import weakest
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.curves import Envelope
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.regions import FOR_EVER, Region, RegionTable
from pvlvrt_compliance.profile.requirements import ReactiveCurrent, RideThrough
from pvlvrt_compliance.profile.requirements.current import beyond_dead_band
from pvlvrt_compliance.report.drawing.colours import OF_A_PROFILE, of_mode
from pvlvrt_compliance.report.drawing.model import Area, Axis, Line, Panel, Points, Run, Scale, Strip
from pvlvrt_compliance.report.drawing.spans import span_of

_SHORTEST_S = 0.01  # where a logarithmic axis of time begins
_LOG_FROM = 30.0  # ratio of the longest to the shortest time that a linear axis no longer shows
_BEYOND = 1.25  # how far a figure goes past the last time
_TOP_PU = 1.4
_PIECES = 24  # of a line that is curved on a logarithmic axis
_WIDTH = 2.0


def panels(profile: Profile, scale: Scale | None = None) -> tuple[Panel, ...]:
    """Return all axes that a profile gives; none for one without curves.

    Parameters
    ----------
    profile : Profile
    scale : {"linear", "log"}, optional
        Of the axes of time; by default logarithmic where the times are too far apart.

    Raises
    ------
    UsageError
        When the profile has nothing to draw.
    """
    found = (*_over_time(profile, scale), *_over_voltage(profile))
    if not found:
        raise UsageError(f"{profile.id}: the profile has no envelope, regions or curve to draw")
    return found


def _panel(
    title: str, x_label: str, y_label: str, scale: Scale, lines: tuple[Line, ...], areas: tuple[Area, ...] = ()
) -> Panel:
    """A panel as wide and high as what is drawn on it; zero is always on the vertical axis."""
    coloured = tuple(line._replace(colour=OF_A_PROFILE[k % len(OF_A_PROFILE)]) for k, line in enumerate(lines))
    x, y = Axis(x_label, scale=scale), Axis(y_label, from_zero=True)
    x_span, y_span = span_of(Panel(title, x, y, coloured, areas))
    return Panel(title, x._replace(span=x_span), Axis(y_label, y_span), coloured, areas)


def _line(name: str, points: Points) -> Line:
    x, y = zip(*points, strict=True)
    return Line(name, (Run(x, y),), width=_WIDTH)


def _over_time(profile: Profile, scale: Scale | None) -> Iterator[Panel]:
    ride_through = profile.ride_through
    if ride_through is None:
        return
    envelopes = {name: envelope for name, envelope in _envelopes(ride_through) if envelope is not None}
    times = [t for envelope in envelopes.values() for t, _ in envelope.points if t > 0]
    if ride_through.regions is not None:
        times += [t for row in ride_through.regions.rows for t in _times_of(row)]
    if not (envelopes or ride_through.regions):
        return
    end_s = _BEYOND * max(times, default=1.0)
    scale = scale or ("log" if times and max(times) > _LOG_FROM * min(times) else "linear")
    begin_s = min([_SHORTEST_S, *(t / 2 for t in times)]) if scale == "log" else 0.0
    shaped = _bent if scale == "log" else tuple
    lines = [_line(_label(name, env), shaped(env.held(begin_s, end_s))) for name, env in envelopes.items()]
    areas = list(_areas(ride_through.regions, begin_s, end_s, scale)) if ride_through.regions else []
    x_label = "time since the start of the disturbance (s)"
    yield _panel("Ride-through", x_label, "voltage (pu)", scale, tuple(lines), tuple(areas))


def _envelopes(ride_through: RideThrough) -> Iterator[tuple[str, Envelope | None]]:
    yield "stay connected above", ride_through.envelope
    yield "two-phase faults: above", ride_through.envelope_two_phase
    yield "stay connected below", ride_through.envelope_over_voltage


def _label(name: str, envelope: Envelope) -> str:
    return f"{name} ({envelope.voltage_quantity.replace('_', ' ')}) [{weakest(envelope.marks)}]"


def _bent(points: Points) -> Points:
    """A line that is straight over time as it looks over the logarithm of time."""
    bent = [points[0]]
    for (t_0, y_0), (t_1, y_1) in pairwise(points):
        pieces = 1 if t_0 == t_1 or y_0 == y_1 else _PIECES
        times = [t_0 * (t_1 / t_0) ** (k / pieces) for k in range(1, pieces)]
        bent += [(t, y_0 + (y_1 - y_0) * (t - t_0) / (t_1 - t_0)) for t in times]
        bent.append((t_1, y_1))
    return tuple(bent)


def _times_of(row: Region) -> list[float]:
    times = [row.ride_through_s(u_pu) for u_pu in row.voltage_pu]
    return [t for t in (*times, row.respond_s or 0.0) if 0 < t < FOR_EVER]


def _areas(table: RegionTable, begin_s: float, end_s: float, scale: Scale) -> Iterator[Area]:
    """Each region as far as its time goes: until when to stay connected, or within which to let go."""
    shaped = _bent if scale == "log" else tuple
    for row in table.rows:
        low, high = row.voltage_pu[0], min(row.voltage_pu[1], max(_TOP_PU, row.voltage_pu[0] + 0.1))
        t_low, t_high = (_until(row, u_pu, begin_s, end_s) for u_pu in row.voltage_pu)
        mark = table.mark_of(row).confidence
        label = f"{row.mode.replace('_', ' ')}, {row.voltage_pu[0]:g} to {row.voltage_pu[1]:g} pu [{mark}]"
        end = shaped(((t_low, low), (t_high, high))) if t_low <= t_high else shaped(((t_high, high), (t_low, low)))
        t, level = zip(*end, strict=True)
        lower, upper = (level, [high] * len(t)) if t_low <= t_high else ([low] * len(t), level)
        strip = Strip((begin_s, *t), (low, *lower), (high, *upper))
        yield Area(label, (strip,), of_mode(row.mode))


def _until(row: Region, u_pu: float, begin_s: float, end_s: float) -> float:
    ride_s = row.ride_through_s(u_pu)
    return max(begin_s, min(end_s, ride_s or row.respond_s or end_s))


def _over_voltage(profile: Profile) -> Iterator[Panel]:
    demands = profile.requirements
    x_label = "positive-sequence voltage (pu)"
    if support := demands.of_kind("reactive_support"):
        line = _line(f"demanded [{support.curve.confidence}]", support.curve.points)
        yield _panel("Reactive support", x_label, "reactive power (pu of rated)", "linear", (line,))
    if demand := demands.of_kind("reactive_current"):
        x_text = "change of the positive-sequence voltage (pu)"
        yield _additional_current("Additional reactive current", x_text, demand, _changes_pu(demand))
    if demand := demands.of_kind("negative_sequence_current"):
        sizes = tuple(-u_pu for u_pu in reversed(_changes_pu(demand)) if u_pu <= 0)
        x_text = "change of the negative-sequence voltage (pu)"
        yield _additional_current("Additional reactive current, negative sequence", x_text, demand, sizes)
    if ratio := demands.of_kind("reactive_ratio"):
        line = _line(f"at least [{ratio.curve.confidence}]", ratio.curve.points)
        yield _panel("Reactive share of the current", x_label, "share of the total current", "linear", (line,))


def _additional_current(title: str, x_label: str, demand: ReactiveCurrent, changes_pu: tuple[float, ...]) -> Panel:
    """Demand and its band over the change of the voltage: below zero for a sag, above for a swell."""
    negative = min(changes_pu) >= 0
    sizes = [(u, _demanded_pu(demand, -u if negative else u)) for u in changes_pu]
    lower = [i - demand.tolerance_minus_pu.value for _, i in sizes]
    upper = [i + demand.tolerance_plus_pu.value for _, i in sizes]
    line = _line(f"demanded, K = {demand.k.value:g} [{demand.k.confidence}]", tuple(sizes))
    strip = Strip(changes_pu, lower, upper)
    band = Area(f"within tolerance [{demand.tolerance_plus_pu.confidence}]", (strip,), OF_A_PROFILE[0])
    return _panel(title, x_label, "current (pu)", "linear", (line,), (band,))


def _changes_pu(demand: ReactiveCurrent) -> tuple[float, ...]:
    """Changes of the voltage at which the demand has a corner, both sides of a step."""
    d, k, limit = demand.dead_band_pu.value, demand.k.value, demand.limit_pu.value
    shift = d if demand.dead_band_mode.value == "shift" else 0.0
    corners = {0.0, 1.0, d, d + 1e-6, min(1.0, limit / k + shift)}
    return tuple(sorted({sign * x for x in corners for sign in (-1, 1) if sign * x <= 0.3}))


def _demanded_pu(demand: ReactiveCurrent, change_pu: float) -> float:
    counted = beyond_dead_band(abs(change_pu), demand.dead_band_pu.value, demand.dead_band_mode.value)
    current = min(demand.k.value * counted, demand.limit_pu.value)
    return current if change_pu < 0 else -current
