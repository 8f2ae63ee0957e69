"""The C twin of plant and controller: builds it, and calls it with the very arguments of `simulation.loop.run`.

Structures and constants of the C sources come from the package's NamedTuples, so no field, order or number is written
twice: a field that is renamed there no longer compiles here.
"""

import ctypes
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control import controller, lvrt, synchronised
from pvlvrt_compliance.control.msogi_fll import MsogiFllState
from pvlvrt_compliance.hardware.hardware import Hardware
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant import diode_bridge, grid, inverter, plant, protection, pv_array
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation import columns, outcome
from pvlvrt_compliance.simulation.door.table import DoorTable
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.space_vectors import SQRT2_3, SQRT3_2

SCENARIOS: Mapping[str, Scenario] = {
    "three-phase 90 %": Scenario(sag=Sag(depth=0.9), duration_s=0.309),
    "phase c 90 %": Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=1.262),
    "isolated two-phase 80 % at 200 W/m2": Scenario(
        sag=Sag(depth=0.8, phases="bc", two_phase=True), duration_s=0.5, irradiance_w_m2=200.0
    ),
    "three-phase 90 % for 500 ms (trips)": Scenario(sag=Sag(depth=0.9), duration_s=0.5),
    "three-phase 90 % at SCR 5": Scenario(sag=Sag(depth=0.9), duration_s=0.309, scr=5.0),
}
"""Runs on which twin and package must agree: faults, the search for the maximum power, a trip, a weak grid."""

_FOLDER = Path(__file__).resolve().parent
CONTROLLER = _FOLDER.parent / "examples" / "bundled-controller-c"
"""The controller in C, which is an example, too."""

_FLAGS = ("-std=gnu99", "-O3", "-march=native", "-fcx-limited-range", "-Wall", "-Wextra", "-shared", "-fPIC")

_OF_CONTROLLER = (
    synchronised.Synchronisation,
    lvrt.LvrtOrder,
    Measured,
    controller.ControllerSignals,
    controller.ControllerState,
    controller.ControllerParams,
)
_OF_PLANT = (
    grid.Source,
    inverter.Bridge,
    plant.Observed,
    plant.PlantParams,
    plant.PlantTables,
    outcome.Outcome,
)
_CONSTANTS_OF_CONTROLLER: Mapping[str, float] = {
    "PI": np.pi,
    "SQRT2_3": SQRT2_3,
    "SQRT3_2": SQRT3_2,
    "BRIDGE_GAIN": inverter.K_PWM,
    "M_MAX": inverter.M_MAX,
}
_CONSTANTS_OF_PLANT: Mapping[str, float] = {
    "NO_CURRENT": diode_bridge.NO_CURRENT,
    "MOST_PARTS": diode_bridge._MOST_PARTS,
    "NEWTON_TOLERANCE": pv_array._NEWTON_TOLERANCE,
    "NEWTON_STEPS": pv_array._NEWTON_STEPS,
    "RELAY_K": protection._K,
    "RELAY_SMALL": protection._SMALL,
    "FREQUENCY_FILTER": protection._FREQUENCY_FILTER,
    "NO_TRIP": protection.NO_TRIP,
    "OVERCURRENT": protection.OVERCURRENT,
    "DC_OVERVOLTAGE": protection.DC_OVERVOLTAGE,
    "UNDERVOLTAGE": protection.UNDERVOLTAGE,
    "FREQUENCY": protection.FREQUENCY,
    "COMPLETED": outcome.COMPLETED,
    "NOT_FINITE": outcome.NOT_FINITE,
    "CHANNELS": len(columns.CHANNELS),
    **{f"COLUMN_{name}": column for column, name in enumerate(columns.CHANNELS)},
}


class _Field(NamedTuple):
    c: str  # how C declares it
    ctype: Any  # how ctypes does


_SCALARS: Mapping[Any, _Field] = {
    float: _Field("double", ctypes.c_double),
    int: _Field("int64_t", ctypes.c_int64),
    bool: _Field("bool", ctypes.c_bool),
    complex: _Field("double complex", ctypes.c_double * 2),
    NDArray[np.float64]: _Field("const double *", ctypes.c_void_p),
    NDArray[np.complex128]: _Field("const double complex *", ctypes.c_void_p),
    NDArray[np.int64]: _Field("const int64_t *", ctypes.c_void_p),
}


def compiler() -> str | None:
    """Path of the C compiler, or None."""
    return shutil.which("gcc")


def _hints(named_tuple: Any) -> dict[str, Any]:
    """Types of the fields; of those that may be none only what the default configuration has."""
    hints = get_type_hints(named_tuple)
    options = {name: (hint,) if hint in _SCALARS else get_args(hint) or (hint,) for name, hint in hints.items()}
    kept = {name: of[0] for name, of in options.items() if type(None) not in of or of[0] is MsogiFllState}
    return {name: hint for name, hint in kept.items() if hint in _SCALARS or _hints(hint)}  # C has no empty structure


def _fields(named_tuple: Any) -> dict[str, _Field]:
    """Fields of a NamedTuple in C; a table of arrays gets one more, their common ``size``."""
    hints = _hints(named_tuple)
    fields = {
        name: _SCALARS[hint] if hint in _SCALARS else _Field(hint.__name__, _structure(hint))
        for name, hint in hints.items()
    }
    if any(field.ctype is ctypes.c_void_p for field in fields.values()):
        fields["size"] = _SCALARS[int]
    return fields


@cache
def _structure(named_tuple: Any) -> Any:
    """Structure of ctypes with the fields of a NamedTuple, nested ones included."""
    members = [(name, field.ctype) for name, field in _fields(named_tuple).items()]
    return type(named_tuple.__name__, (ctypes.Structure,), {"_fields_": members})


def _nested(named_tuple: Any) -> list[Any]:
    """All NamedTuples that one consists of, itself last."""
    hints = _hints(named_tuple).values()
    return [inner for hint in hints if hint not in _SCALARS for inner in _nested(hint)] + [named_tuple]


def controller_layout() -> str:
    """Text of the example's ``structures.h``: structures and constants of the package's controller, in C."""
    head = "/* Structures and constants of the package's controller; written by benchmarks/twin.py from its own. */"
    order = _in_order(_OF_CONTROLLER)
    return "\n".join([head, "#pragma once", "", *_in_c(order, _CONSTANTS_OF_CONTROLLER), ""])


def plant_layout() -> str:
    """Text of ``layout.h``: what the twin needs besides."""
    known = _in_order(_OF_CONTROLLER)
    order = [named_tuple for named_tuple in _in_order(_OF_PLANT) if named_tuple not in known]
    return "\n".join(["#pragma once", "", *_in_c(order, _CONSTANTS_OF_PLANT), ""])


def _in_order(structures: Iterable[Any]) -> list[Any]:
    return list(dict.fromkeys(inner for outer in structures for inner in _nested(outer)))


def _in_c(structures: Iterable[Any], constants: Mapping[str, float]) -> Iterator[str]:
    for named_tuple in structures:
        members = " ".join(f"{field.c} {name};" for name, field in _fields(named_tuple).items())
        yield f"typedef struct {{ {members} }} {named_tuple.__name__};"
    for name, value in constants.items():
        yield f"#define {name} {value if isinstance(value, int) else float(value).hex()}"


def _packed(value: Any) -> Any:
    """Structure of ctypes with the values of a NamedTuple; arrays stay where they are."""
    named_tuple: Any = type(value)
    present = [getattr(value, name) for name in _hints(named_tuple)]
    arrays = [x for x in present if isinstance(x, np.ndarray)]
    members = [_member(x) for x in present] + [len(x) for x in arrays[:1]]
    return _structure(named_tuple)(*members)


def _member(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            raise ValueError("the twin reads contiguous arrays")
        return value.ctypes.data
    if isinstance(value, complex):
        return (ctypes.c_double * 2)(value.real, value.imag)
    return _packed(value) if isinstance(value, tuple) else value


def _unpacked(named_tuple: Any, structure: Any) -> Any:
    """NamedTuple with the values of a structure of ctypes."""
    values = {}
    for name, hint in _hints(named_tuple).items():
        value = getattr(structure, name)
        values[name] = complex(*value) if hint is complex else value if hint in _SCALARS else _unpacked(hint, value)
    return named_tuple(**values)


class Arguments(NamedTuple):
    """What `simulation.loop.run` takes."""

    plant: plant.PlantState
    controller: controller.ControllerState
    m: complex
    first: int
    plant_params: plant.PlantParams
    tables: plant.PlantTables
    controller_params: controller.ControllerParams
    hardware: Hardware | None  # the twin has none
    door: DoorTable | None  # nor this
    plan: RecordingPlan  # the twin records every period
    samples: NDArray[np.float64]
    k: int = 0  # samples before; the twin begins

    @property
    def plant_steps(self) -> int:
        """Plant steps of the run, unrecorded settling included."""
        return self.plant_params.ratio * (len(self.samples) - self.first)


def arguments_of(scenario: Scenario, parameters: Parameters | None = None) -> Arguments:
    """Arguments that `simulate` hands to its loop in a scenario; a sample that no run fills stays NaN."""
    seen: list[Arguments] = []

    def no_loop(*arguments: Any) -> outcome.Outcome:
        seen.append(Arguments(*arguments))
        return outcome.Outcome(status=outcome.COMPLETED, period=0, plant=arguments[0])

    simulate(scenario, parameters or Parameters(), run=no_loop)
    seen[0].samples.fill(np.nan)
    return seen[0]


class Twin:
    """The compiled twin, built into a folder that must outlive it.

    Raises
    ------
    FileNotFoundError
        Without gcc.
    ValueError
        When the package's structures have changed since ``structures.h`` was written.
    subprocess.CalledProcessError
        When the sources do not compile, for instance because a field of the package was renamed.
    """

    def __init__(self, folder: Path) -> None:
        gcc = compiler()
        if gcc is None:
            raise FileNotFoundError("the twin needs gcc")
        if (CONTROLLER / "structures.h").read_text("utf-8") != controller_layout():
            raise ValueError("structures.h is not that of the package any more: run benchmarks/twin.py")
        (folder / "layout.h").write_text(plant_layout(), encoding="utf-8")
        library = folder / "twin.so"
        subprocess.run(
            [
                gcc,
                *_FLAGS,
                "-I",
                str(CONTROLLER),
                "-I",
                str(folder),
                str(_FOLDER / "twin.c"),
                "-o",
                str(library),
                "-lm",
            ],
            check=True,
        )
        self._run = ctypes.CDLL(str(library)).run
        self._run.restype = _structure(outcome.Outcome)

    def prepare(self, arguments: Arguments) -> Callable[[], Any]:
        """Bare call of the compiled loop on these arguments, which must stay alive; fills their samples."""
        a = arguments
        if not (a.samples.flags.f_contiguous and a.samples.dtype == np.float64):
            raise ValueError("the twin writes float64 samples, each channel in one piece")
        if a.hardware is not None:
            raise ValueError("the twin has ideal hardware only")
        if a.k != 0:
            raise ValueError("the twin begins at the beginning")
        if a.door is not None:
            raise ValueError("the twin has the bundled controller only")
        if a.controller_params.precision.double is None:
            raise ValueError("the twin computes in double precision only")
        packed = [_packed(x) for x in (a.plant, a.controller, a.plant_params, a.tables, a.controller_params)]
        start, control, params, tables, control_params = map(ctypes.byref, packed)
        m, first, count = _member(complex(a.m)), ctypes.c_int64(a.first), ctypes.c_int64(len(a.samples))
        samples = ctypes.c_void_p(a.samples.ctypes.data)
        return lambda: self._run(start, control, m, first, params, tables, control_params, samples, count)

    def run(self, arguments: Arguments) -> outcome.Outcome:
        """Run the twin; fills the samples."""
        ended: outcome.Outcome = _unpacked(outcome.Outcome, self.prepare(arguments)())
        return ended


if __name__ == "__main__":
    (CONTROLLER / "structures.h").write_text(controller_layout(), encoding="utf-8")
