"""FMUs as controllers: the same waveforms as by the other doors, and what is refused, with the reason."""

import json
import re
import sys
import tempfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmu_sources import CLOCK, EXPERIMENT, built, compiled, description, packed

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.fmu.door import FmuDoor
from pvlvrt_compliance.controllers.in_process import Debugged
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate

pytestmark = pytest.mark.compiler

FOLDER = Path(__file__).parent
SAME_START = ("simulation.settling_s=0.5", "simulation.synchronising_s=0")
QUICK = parameters_from(("simulation.settling_s=0.02", "simulation.synchronising_s=0.01"))
NO_RELAYS = parameters_from(
    ("simulation.settling_s=0.02", "simulation.synchronising_s=0.01", "protection.overcurrent_pu=100")
)
"""Nothing trips: a controller that goes on with what modulates loses its plant, and what it does wrong counts."""

SHORT = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
PORTS_3 = (("inputs", "m_in"), ("outputs", "m_out"))
MAPPING_3 = "".join(
    [f"[{side}]\n" + "".join(f'"{port}[{k}]" = "m_{x}"\n' for k, x in enumerate("abc")) for side, port in PORTS_3]
)
MAPPING_2 = '[outputs]\nm_a_out = "m_a"\nm_b_out = "m_b"\nm_c_out = "m_c"\n'


def furthest(mine, theirs, names):
    """Largest difference of two records, by the largest value of each channel."""
    pairs = [(mine.segments[0][name], theirs.segments[0][name]) for name in names]
    return max(np.abs(a - b).max() / max(np.abs(b).max(), 1e-3) for a, b in pairs)


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    """Give the small FMU by FMI's version, with its mapping beside it."""
    made = {}

    def small(version):
        if version not in made:
            folder = tmp_path_factory.mktemp(f"fmi{version}")
            place = fmpy.platform_tuple if version == 3 else fmpy.platform
            made[version] = packed(folder, description(version), compiled(folder, version), place)
            mapping = MAPPING_3 if version == 3 else MAPPING_2
            (folder / "small.mapping.toml").write_text(mapping, "utf-8")
        return made[version]

    return small


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_brings_what_it_is_made_of(small, version):
    """Its binary takes nothing from elsewhere, so that its file alone decides what it does."""
    assert FmuDoor(str(small(version)), {}).besides() == ""


def without_binary(folder, text, place="nowhere"):
    """FMU whose binary, if it has a place, is an empty file."""
    binary = folder / f"small{fmpy.sharedLibraryExtension}"
    binary.touch()
    return str(packed(folder, text, binary if place else None, place))


def here(version):
    """Folder for binaries of this platform."""
    return fmpy.platform_tuple if version == 3 else fmpy.platform


@pytest.mark.slow
def test_bundled_controller_in_an_fmu(tmp_path):
    """An FMU that holds the bundled controller gives its waveforms within 1e-6."""
    simulator = ForeignSimulator(str(built(FOLDER / "bundled_fmu2.py", tmp_path / "made")))
    scenario, parameters = Scenario(sag=Sag(depth=0.9), duration_s=0.309), parameters_from(SAME_START)
    names = ("i_a_a", "i_b_a", "i_c_a", "v_dc_v", "i_pv_a", "m_alpha", "m_beta", "v_fault_pu")
    assert simulator.description.kind == "fmi2"
    assert furthest(simulator(scenario, parameters), simulate(scenario, parameters), names) < 1e-6


@pytest.mark.parametrize("version", [2, 3])
def test_compiled_fmu(small, opened, version):
    """An FMU in C, FMI 2 with scalars or FMI 3 with arrays, does what the same in Python does; parameters reach it."""
    simulator = ForeignSimulator(str(small(version)), {"gain": 0.98})
    mine, theirs = simulator(SHORT, QUICK), opened("small.py:Small", gain=0.98)(SHORT, QUICK)
    assert simulator.description.kind == f"fmi{version}"
    assert furthest(mine, theirs, ("i_a_a", "v_dc_v", "m_alpha", "m_beta")) < 1e-12
    debugged = Debugged(str(small(version)), {"gain": 0.98})
    assert all(furthest(debugged(SHORT, QUICK), mine, [name]) == 0 for name in mine.segments[0].channels)
    other = ForeignSimulator(str(small(version)))(SHORT, QUICK)
    assert furthest(other, theirs, ["m_alpha"]) > 1e-3


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(
    ("status", "reason"),
    [
        (2, "DoStep gave discard"),
        (3, "DoStep gave error"),
        (4, "DoStep gave fatal error"),
        (6, "asks for the end of the simulation"),
    ],
)
def test_failing_step(small, version, status, reason):
    """A step that fails, or asks for the end, is an error with the simulated time and what the FMU has logged."""
    given = {"fail_at_s": 0.1, "status": status}
    with pytest.raises(SimulationError, match=f"(?s)at 0.07.*{reason}.*limit 42 reached by the link"):
        ForeignSimulator(str(small(version)), given)(SHORT, NO_RELAYS)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(("status", "reason"), [(3, "DoStep gave error"), (4, "DoStep gave fatal error")])
def test_failing_step_after_a_trip(small, version, status, reason):
    """After a trip it is a note, with the time and what the FMU has logged; the record goes on, the breaker open."""
    simulator = ForeignSimulator(str(small(version)), {"fail_at_s": 0.1, "status": status})
    record = simulator(SHORT, QUICK)
    assert record.end_s == pytest.approx(SHORT.end_s, abs=1e-4)
    assert record.segments[0]["connected"][-1] == 0
    (note,) = simulator.notes
    assert re.match(rf"(?s)ignored, as it came after a trip: .*at 0.07.*{reason}.*limit 42 reached by the link", note)


@pytest.mark.parametrize("version", [2, 3])
def test_warning(small, version):
    """By FMI a warning ends nothing: the run goes on and the warning stands in its notes."""
    simulator = ForeignSimulator(str(small(version)), {"fail_at_s": 0.1, "status": 1})
    simulator(SHORT, QUICK)
    (note,) = simulator.notes
    assert "limit 42 reached by the link" in note


def test_pending_step(small):
    """An FMU that computes asynchronously is refused at its first such step."""
    with pytest.raises(SimulationError, match="asynchronously"):
        ForeignSimulator(str(small(2)), {"fail_at_s": 0.1, "status": 5, "softly": True})(SHORT, NO_RELAYS)


def test_nothing_is_left(small, tmp_path, monkeypatch):
    """What was unpacked is gone after a run, also after one that failed."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    ForeignSimulator(str(small(2)))(SHORT, QUICK)
    with pytest.raises(SimulationError):
        ForeignSimulator(str(small(2)), {"fail_at_s": 0.1, "status": 4})(SHORT, NO_RELAYS)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("version", [2, 3])
def test_description(small, version):
    """Ports, widths, parameters with ranges and the sample time are those of modelDescription.xml."""
    found = FmuDoor(str(small(version)), {}).describe()
    assert found.sample_time_s == 1e-4
    assert sum(port.width for port in found.inputs) == sum(port.width for port in found.outputs) == 3
    assert {p.name: (p.value, p.minimum, p.maximum) for p in found.parameters} == {
        "gain": (1.0, 0.0, 2.0),
        "fail_at_s": (1e9, None, None),
        "status": (0, 0.0, 6.0),
        "softly": (False, None, None),
    }
    assert json.dumps(found.to_json())


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"gian": 1.0}, 'did you mean "gain"'),
        ({"gain": 2.5}, "2.5 is out of range; 0 to 2 is allowed"),
        ({"gain": "much"}, "'much' is not a number"),
        ({"status": 1.5}, "1.5 is not a whole number"),
        ({"softly": 1}, "1 is not true or false"),
        ({"sample_time_s": -1.0}, "not a number of seconds above zero"),
    ],
)
def test_unusable_parameters(small, given, reason):
    """A parameter that the FMU does not have, or outside of its range, is refused before anything runs."""
    with pytest.raises(DoorError, match=reason):
        FmuDoor(str(small(2)), given)


@pytest.mark.parametrize("version", [2, 3])
def test_sample_time(tmp_path, version):
    """It is the one that is given, else of the FMU's clock, else its step size, else there is none."""
    file = without_binary(tmp_path, description(version), here(version))
    assert FmuDoor(file, {"sample_time_s": 5e-5}).describe().sample_time_s == 5e-5
    assert FmuDoor(file, {}).describe().sample_time_s == 1e-4
    file = without_binary(tmp_path, description(version, experiment=""), here(version))
    with pytest.raises(DoorError, match=r"give --set controller\.sample_time_s="):
        FmuDoor(file, {})
    if version == 3:
        file = without_binary(tmp_path, description(3, clock=CLOCK), here(3))
        assert FmuDoor(file, {}).describe().sample_time_s == 2e-4


@pytest.mark.parametrize(
    ("version", "kind", "reason"),
    [
        (2, "ModelExchange", "model exchange .*no solver.* only; export it for co-simulation"),
        (3, "ModelExchange", "model exchange .*no solver.* only; export it for co-simulation"),
        (3, "ScheduledExecution", "scheduled execution .*clocks.* only; export it for co-simulation"),
    ],
)
def test_other_kinds_of_fmu(tmp_path, version, kind, reason):
    """An FMU that is not for co-simulation is refused with the reason."""
    file = without_binary(tmp_path, description(version, kind=kind), here(version))
    with pytest.raises(DoorError, match=reason):
        FmuDoor(file, {})


def test_other_platform(tmp_path):
    """An FMU without a binary for this platform is refused with those that it has."""
    with pytest.raises(DoorError, match=f"no binary for {here(2)}; it has: amiga"):
        FmuDoor(without_binary(tmp_path, description(2), "amiga"), {})
    with pytest.raises(DoorError, match="none at all"):
        FmuDoor(without_binary(tmp_path, description(2), ""), {})


def test_unusable_binary(tmp_path):
    """A binary that cannot be loaded is refused when it is to run."""
    (tmp_path / "small.mapping.toml").write_text(MAPPING_2, "utf-8")
    simulator = ForeignSimulator(without_binary(tmp_path, description(2), here(2)))
    with pytest.raises(SimulationError, match="its binary cannot be loaded"):
        simulator(SHORT, QUICK)


def test_careless_description(tmp_path):
    """What the standard forbids and nothing here needs is noted, not refused."""
    text = description(2).replace('name="softly"', 'name="gain"')
    (note,) = FmuDoor(without_binary(tmp_path, text, here(2)), {}).describe().notes
    assert "not unique" in note


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (None, "is not an FMU"),
        ("<fmiModelDescription/>", "cannot be used"),
        (description(2, experiment=EXPERIMENT).replace("</ModelVariables>", ""), "cannot be used"),
    ],
)
def test_no_fmu(tmp_path, text, reason):
    """A file that is no FMU is refused."""
    file = tmp_path / "bad.fmu"
    file.write_text("nothing", "utf-8")
    if text is not None:
        file = packed(tmp_path, text, None, "")
    with pytest.raises(DoorError, match=reason):
        FmuDoor(str(file), {})


def test_without_the_library(tmp_path, monkeypatch):
    """Without fmpy, the extra that brings it is named."""
    monkeypatch.setitem(sys.modules, "fmpy", None)
    with pytest.raises(DoorError, match=r"pvlvrt-compliance\[fmi\]"):
        FmuDoor(without_binary(tmp_path, description(2), ""), {})
