"""Controllers that cannot be run, behind every door, each with what is to be told of it: made for the tests."""

import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import pytest
from fmu_sources import SOURCE, compiled, description, packed

_LIBRARY = Path(__file__).parents[1] / "controllers" / "library" / "misbehaving.c"
_MAPPING = "[outputs]\n" + "".join(f'm_{phase}_out = "m_{phase}"\n' for phase in "abc")


class Broken(NamedTuple):
    """A controller that cannot be run."""

    arguments: tuple[str, ...]  # of `controllers inspect`
    port: str  # one that it has all the same
    told: str  # regular expression of what is wrong
    in_a_run: bool = True  # whether a run comes as far, and so says the same


def _fmu(folder: Path, told: str, changes: Mapping[str, str] | None = None, text: str = "", place: str = "") -> Broken:
    """The small FMU with its source changed, another description, or its binary elsewhere."""
    import fmpy

    source = SOURCE.read_text("utf-8")
    for old, new in (changes or {}).items():
        assert old in source
        source = source.replace(old, new)
    own = folder / "source.c"
    own.write_text(source, "utf-8")
    file = packed(folder, text or description(2), compiled(folder, 2, own), place or fmpy.platform)
    (folder / "small.mapping.toml").write_text(_MAPPING, "utf-8")
    return Broken((str(file),), "m_a_out", told)


def fmu_with_another_token(folder: Path) -> Broken:
    """One whose binary was built with another."""
    refuses = 'functions->logger(NULL, "small", 3, "e", "GUID %s is not mine", guid);\n    return NULL;'
    told = r"fmi2Instantiate gave no instance: most often the guid .* '\{1\}'.*\n.*GUID \{1\} is not mine"
    return _fmu(folder, told, {"callbacks = functions;\n    return numbers;": refuses})


def fmu_without_functions(folder: Path) -> Broken:
    """One whose binary lacks two of those that FMI demands."""
    lacks = dict.fromkeys(("DO_NOTHING(fmi2Reset)\n", "DO_NOTHING(fmi2Terminate)\n"), "")
    return _fmu(folder, "small.so has no function fmi2Reset, fmi2Terminate", lacks)


def fmu_with_loose_ends(folder: Path) -> Broken:
    """One whose binary needs two functions that nothing has."""
    step = "static int step(double t)\n{\n"
    loose = f"double nowhere_one(double), nowhere_two(double);\n{step}    t += 0 * nowhere_one(nowhere_two(t));\n"
    return _fmu(folder, "undefined symbol: nowhere_.*likewise missing: nowhere_", {step: loose})


def fmu_that_is_no_library(folder: Path) -> Broken:
    """One whose binary is a text."""
    made = _fmu(folder, "its binary cannot be loaded: small.so is not a shared library")
    (folder / "small.so").write_text("no ELF", "utf-8")
    import fmpy

    packed(folder, description(2), folder / "small.so", fmpy.platform)
    return made


def fmu_of_another_platform(folder: Path) -> Broken:
    """One that was built elsewhere."""
    return _fmu(folder, "it has no binary for .*; it has: amiga", place="amiga")


def fmu_of_fmi_1(folder: Path) -> Broken:
    """One of the first version."""
    text = """<fmiModelDescription fmiVersion="1.0" modelName="old" modelIdentifier="small" guid="{1}"
    numberOfContinuousStates="0" numberOfEventIndicators="0"><ModelVariables>
    <ScalarVariable name="m_a_out" valueReference="1" causality="output"><Real/></ScalarVariable></ModelVariables>
    <Implementation><CoSimulation_StandAlone><Capabilities/></CoSimulation_StandAlone></Implementation>
    </fmiModelDescription>"""
    return _fmu(folder, r"it is an FMU of FMI 1\.0; FMI 2 and FMI 3 can be used", text=text)


def fmu_for_model_exchange(folder: Path) -> Broken:
    """One that wants a solver."""
    return _fmu(folder, "for model exchange .* only", text=description(2, kind="ModelExchange"))


def fmu_without_a_sample_time(folder: Path) -> Broken:
    """One that does not say how often it is to be stepped."""
    return _fmu(folder, r"give --set controller\.sample_time_s=", text=description(2, experiment=""))


def fmu_that_crashes(folder: Path) -> Broken:
    """One that ends its process when it is instantiated."""
    crash = {"callbacks = functions;\n    return numbers;": "return (void *)(size_t) * (volatile int *)NULL;"}
    return _fmu(folder, r"the controller crashed \(SIGSEGV\) while it was opened", crash)


def _library(folder: Path, told: str, changes: Mapping[str, str] | None = None, flags: tuple[str, ...] = ()) -> Broken:
    from pvlvrt_compliance.controllers.library import HEADER

    gcc = shutil.which("gcc") or pytest.skip("gcc is missing, so no controller in C can be built")
    source = _LIBRARY.read_text("utf-8")
    for old, new in (changes or {}).items():
        assert old in source
        source = source.replace(old, new)
    own, library = folder / "broken.c", folder / "libbroken.so"
    own.write_text(source, "utf-8")
    subprocess.run(
        [gcc, "-shared", "-fPIC", f"-I{HEADER.parent}", *flags, str(own), "-o", str(library), "-lm"], check=True
    )
    return Broken((str(library),), "below_v", told)


def library_without_functions(folder: Path) -> Broken:
    """One that lacks two of those that the interface demands."""
    flags = ("-DModel_Outputs=Other_Outputs", "-DModel_Terminate=Other_Terminate")
    return _library(folder, "libbroken.so has no function Model_Outputs and Model_Terminate", flags=flags)


def library_with_loose_ends(folder: Path) -> Broken:
    """One that needs two functions which nothing has; it can be asked what it is, as it is linked so."""
    include = '#include "ieee_cigre.h"'
    changes = {
        include: f"{include}\ndouble nowhere_one(double), nowhere_two(double);",
        "sqrt(squares / 3) >=": "nowhere_one(nowhere_two(squares)) >=",
    }
    told = "cannot be loaded: .*undefined symbol: nowhere_.*likewise missing: nowhere_"
    return _library(folder, told, changes, ("-Wl,-z,lazy",))


def library_for_rms(folder: Path) -> Broken:
    """One that is for phasors only."""
    return _library(folder, "for RMS simulation only", flags=("-DRMS_ONLY",))


def library_that_refuses(folder: Path) -> Broken:
    """One that does not like its own parameters."""
    head = "Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance)\n{\n"
    refuses = f'{head}    instance->LastErrorMessage = "no licence found";\n    if (instance)\n        return 2;\n'
    return _library(folder, "Model_CheckParameters failed: no licence found", {head: refuses})


def library_with_wrong_settings(folder: Path) -> Broken:
    """One with a parameter and a mapping that do not fit: both are told."""
    made = _library(folder, r"(?s)controller\.hw: .*did you mean \"how\".*mine\.toml:2: inputs\.m_x: .*no such input")
    (folder / "mine.toml").write_text('[inputs]\nm_x = "m_a"\n[outputs]\ncalls = {record = "n"}\n', "utf-8")
    more = ("--set", "controller.hw=3", "--mapping", str(folder / "mine.toml"))
    return made._replace(arguments=(*made.arguments, *more), in_a_run=False)


_PYTHON = """
{first}


class Base:
    sample_time_s = 1e-4
    commands_voltages = True

    def __init__(self, VLLbase=600.0, how="well"):
        self.how = how
        if how == "badly":
            raise ValueError("no such mode")

    def reset(self, nominal):
        if self.how == "later":
            raise ValueError("no licence found")


class Controller(Base):
    switches = ("trip",)
{step}
"""
_STEP = "    def step(self, y):\n        return 0.0, 0.0, 0.0, False"


def _python(folder: Path, told: str, *more: str, first: str = "", step: str = _STEP) -> Broken:
    (folder / "mine.py").write_text(_PYTHON.format(first=first, step=step), "utf-8")
    return Broken((f"{folder / 'mine.py'}:Controller", *more), "u_a_ref_v", told)


def python_that_cannot_be_imported(folder: Path) -> Broken:
    """One that needs a package which is not there."""
    return _python(folder, "cannot be imported: ModuleNotFoundError: .*nowhere_at_all", first="import nowhere_at_all")


def python_that_cannot_be_made(folder: Path) -> Broken:
    """One whose constructor raises."""
    return _python(folder, "Controller cannot be made: ValueError: no such mode", "--set", "controller.how=badly")


def python_that_cannot_be_reset(folder: Path) -> Broken:
    """One that raises when a run begins."""
    told = r"reset\(\) failed: ValueError: no licence found"
    return _python(folder, told, "--set", "controller.how=later")


def python_without_a_step(folder: Path) -> Broken:
    """One that lacks a method."""
    return _python(folder, r"Controller has no method step\(\)", step="")


_PROGRAM = """
import json, sys

deed = sys.argv[1]
hello = {"version": 1, "sample_time_s": 1e-4, "inputs": ["u_a_v"], "outputs": ["m_a", "m_b", "m_c"]}
given = json.loads(sys.stdin.readline())["parameters"]
if deed == "mistaken":
    hello.update(inputs=["u_a_v", {"nam": "x"}], vesrion=1)
if deed == "gives up" and given:
    hello = {"error": "no such mode"}
print(json.dumps(hello), flush=True)
sys.stdin.readline()
print(json.dumps({"ready": deed != "never ready"}), flush=True)
"""


def _program(folder: Path, deed: str, told: str, *more: str) -> Broken:
    (folder / "mine.py").write_text(_PROGRAM, "utf-8")
    return Broken((f'stdio:"{sys.executable}" "{folder / "mine.py"}" "{deed}"', *more), "u_a_v", told)


def program_with_a_mistaken_hello(folder: Path) -> Broken:
    """One whose answer has a port without a name, and a key that is not known."""
    return _program(folder, "mistaken", r'(?s)inputs\[1\]\.name: missing.*vesrion: unknown key; did you mean "version"')


def program_that_is_never_ready(folder: Path) -> Broken:
    """One that does not answer the start."""
    return _program(folder, "never ready", "it must answer the start by")


def program_that_gives_up(folder: Path) -> Broken:
    """One that does not like its parameters, and says what it is without them."""
    return _program(folder, "gives up", "the program gave up: no such mode", "--set", "controller.mode=7")


ALL: Mapping[str, Callable[[Path], Broken]] = {
    make.__name__: make
    for make in (
        *(fmu_with_another_token, fmu_without_functions, fmu_with_loose_ends, fmu_that_is_no_library),
        *(fmu_of_another_platform, fmu_of_fmi_1, fmu_for_model_exchange, fmu_without_a_sample_time, fmu_that_crashes),
        *(library_without_functions, library_with_loose_ends, library_for_rms, library_that_refuses),
        library_with_wrong_settings,
        *(python_that_cannot_be_imported, python_that_cannot_be_made, python_that_cannot_be_reset),
        python_without_a_step,
        *(program_with_a_mistaken_hello, program_that_is_never_ready, program_that_gives_up),
    )
}
