"""FMUs that give their state: the bundled controller in C behind FMI 2 and FMI 3 (`fmu/stateful_fmu.c`)."""

from pathlib import Path

import fmpy
from fmu_sources import compiled, packed

from pvlvrt_compliance.controllers.library import HEADER

HERE = Path(__file__).parent
SOURCE = HERE / "fmu" / "stateful_fmu.c"
CONTROLLER = HERE.parents[1] / "examples" / "bundled-controller-c"
SAYS = {
    2: ("canGetAndSetFMUstate", "canSerializeFMUstate"),
    3: ("canGetAndSetFMUState", "canSerializeFMUState"),
}
"""Attributes by which it says that its state can be had, and serialised, by FMI's version."""

_INPUTS = (
    *("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "v_dc_v", "i_pv_a"),
    *("q_set_var", "frequency_nominal_hz", "apparent_power_nominal_va", "voltage_nominal_v"),
    *("enabled", "m_a_now", "m_b_now", "m_c_now"),
)
_OUTPUTS = ("m_a", "m_b", "m_c", "v_fault_pu", "q_ref_var", "p_ref_w")
_MAPPING = "[inputs]\n" + "".join(f'm_{x}_now = "m_{x}"\n' for x in "abc")
_ROOT = {
    2: '<fmiModelDescription fmiVersion="2.0" modelName="stateful" guid="{1}">',
    3: '<fmiModelDescription fmiVersion="3.0" modelName="stateful" instantiationToken="{1}">',
}
_STRUCTURE = {2: '<Unknown index="{}"/>', 3: '<Output valueReference="{}"/>'}


def description(version: int, says: tuple[str, ...]) -> str:
    """Give its modelDescription.xml, with these attributes true."""
    variables = [(name, k, "input", "0") for k, name in enumerate(_INPUTS)]
    variables += [(name, 100 + k, "output", "") for k, name in enumerate(_OUTPUTS)]
    variables += [("warns_at_s", 200, "parameter", "1e9")]
    first = 1 + len(_INPUTS)
    outputs = [str(first + k if version == 2 else 100 + k) for k in range(len(_OUTPUTS))]
    structure = "".join(_STRUCTURE[version].format(output) for output in outputs)
    true = " ".join(f'{name}="true"' for name in says)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
{_ROOT[version]}
<CoSimulation modelIdentifier="small" {true}/>
<DefaultExperiment stepSize="40.9568e-6"/>
<ModelVariables>{"".join(_variable(version, *variable) for variable in variables)}</ModelVariables>
<ModelStructure>{f"<Outputs>{structure}</Outputs>" if version == 2 else structure}</ModelStructure>
</fmiModelDescription>"""


def _variable(version: int, name: str, reference: int, causality: str, start: str) -> str:
    varies = "fixed" if causality == "parameter" else "discrete"
    head = f'name="{name}" valueReference="{reference}" causality="{causality}" variability="{varies}"'
    begin = f'start="{start}"' if start else ""
    return f"<ScalarVariable {head}><Real {begin}/></ScalarVariable>" if version == 2 else f"<Float64 {head} {begin}/>"


def made(folder: Path, version: int, *definitions: str, says: tuple[str, ...] | None = None) -> str:
    """FMU with its mapping beside it, in a folder of its own; by default it says all that it can."""
    folder.mkdir()
    flags = (f"-I{CONTROLLER}", f"-I{HEADER.parent}", *(f"-D{name}" for name in definitions))
    binary = compiled(folder, version, SOURCE, "-Wall", "-Wextra", "-Werror", *flags)
    (folder / "small.mapping.toml").write_text(_MAPPING, "utf-8")
    place = fmpy.platform_tuple if version == 3 else fmpy.platform
    return str(packed(folder, description(version, SAYS[version] if says is None else says), binary, place))
