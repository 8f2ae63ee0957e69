"""FMUs made for the tests."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

HERE = Path(__file__).parent
SOURCE = HERE / "fmu" / "small_fmu.c"

HEAD_2 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="small" version="1.2" guid="{{1}}">
  <{kind} modelIdentifier="small"/>
  {experiment}
  <ModelVariables>
"""
REAL_2 = """<ScalarVariable name="{name}" valueReference="{vr}" causality="{causality}" {more}>
<Real {start}/></ScalarVariable>
"""
TAIL_2 = """
<ScalarVariable name="status" valueReference="100" causality="parameter" variability="fixed">
<Integer start="0" min="0" max="6"/></ScalarVariable>
<ScalarVariable name="softly" valueReference="101" causality="parameter" variability="fixed">
<Boolean start="false"/></ScalarVariable>
</ModelVariables><ModelStructure><Outputs><Unknown index="4"/><Unknown index="5"/><Unknown index="6"/></Outputs>
</ModelStructure></fmiModelDescription>
"""
TEXT_3 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="small" instantiationToken="{{1}}">
  <{kind} modelIdentifier="small"/>
  {experiment}
  <ModelVariables>
    <Float64 name="m_in" valueReference="0" causality="input" start="0 0 0"><Dimension start="3"/></Float64>
    <Float64 name="m_out" valueReference="3" causality="output"><Dimension start="3"/></Float64>
    <Float64 name="gain" valueReference="6" causality="parameter" variability="tunable" start="1" min="0" max="2"/>
    <Float64 name="fail_at_s" valueReference="7" causality="parameter" variability="fixed" start="1e9"/>
    <Int32 name="status" valueReference="100" causality="parameter" variability="fixed" start="0" min="0" max="6"/>
    <Boolean name="softly" valueReference="101" causality="parameter" variability="fixed" start="false"/>
    <Float64 name="time" valueReference="999" causality="independent" variability="continuous"/>
    {clock}
  </ModelVariables>
  <ModelStructure><Output valueReference="3"/></ModelStructure>
</fmiModelDescription>
"""
EXPERIMENT = '<DefaultExperiment stepSize="1e-4"/>'
CLOCK = (
    '<Clock name="tick" valueReference="200" causality="input" intervalVariability="constant" intervalDecimal="2e-4"/>'
)


def description(version: int, kind: str = "CoSimulation", experiment: str = EXPERIMENT, clock: str = "") -> str:
    """Give a modelDescription.xml of the small FMU."""
    if version == 3:
        return TEXT_3.format(kind=kind, experiment=experiment, clock=clock)
    reals = [(f"m_{x}", k, "input", "", 'start="0"') for k, x in enumerate("abc")]
    reals += [(f"m_{x}_out", 3 + k, "output", "", "") for k, x in enumerate("abc")]
    fixed = 'variability="fixed"'
    reals += [("gain", 6, "parameter", 'variability="tunable"', 'start="1" min="0" max="2"')]
    reals += [("fail_at_s", 7, "parameter", fixed, 'start="1e9"')]
    keys = ("name", "vr", "causality", "more", "start")
    body = "".join(REAL_2.format(**dict(zip(keys, real, strict=True))) for real in reals)
    return HEAD_2.format(kind=kind, experiment=experiment) + body + TAIL_2


def packed(folder: Path, text: str, binary: Path | None, place: str) -> Path:
    """FMU of a description, and a binary in one of the folders for them."""
    file = folder / "small.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        if binary is not None:
            archive.write(binary, f"binaries/{place}/small{binary.suffix}")
    return file


def compiled(folder: Path, version: int, source: Path = SOURCE, *flags: str) -> Path:
    """Binary of the small FMU, or of another source, with flags; skips where there is no compiler."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    rest = "\n".join(f"DO_NOTHING({name})" for name in _rest_of_fmi(version, source))
    (folder / "rest_of_fmi.h").write_text(rest, "utf-8")
    binary = folder / "small.so"
    given = ["-O1", "-shared", "-fPIC", f"-DFMI={version}", f"-I{folder}", *flags]
    subprocess.run([compiler, *given, str(source), "-o", str(binary), "-lm"], check=True)
    return binary


def _rest_of_fmi(version: int, source: Path) -> list[str]:
    """Functions of FMI that the library insists on and a source does not have."""
    from fmpy.fmi2 import FMU2Slave
    from fmpy.fmi3 import FMU3Slave

    text = source.read_text("utf-8")
    names = dir(FMU2Slave if version == 2 else FMU3Slave)
    return [name for name in names if name.startswith(f"fmi{version}") and f"{name}(" not in text]


def built(script: Path, folder: Path, package: str = "pythonfmu") -> Path:
    """FMU of the class in a script, by a builder in a process of its own: it imports the script and leaves traces."""
    folder.mkdir(exist_ok=True)
    code = f"import sys; sys.path[:] = {sys.path!r}; from {package}.__main__ import cli_main; cli_main()"
    arguments = ["build", "-f", str(script), "-d", str(folder)]
    found = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    (file,) = folder.glob("*.fmu")
    return file
