"""The filter of examples/replay by every door, and files of signals for it."""

import sys
from functools import cache
from pathlib import Path

import fmu_sources
import numpy as np
import pytest

from pvlvrt_compliance.waveforms.csv import exact_text

HERE = Path(__file__).parent
EXAMPLE = Path(__file__).resolve().parents[3] / "examples" / "replay"

PLAIN = "    numbers[OUTPUT + k] = numbers[GAIN] * numbers[k];\n"
FILTER = """    {
        static double z[3][2];
        const double b0 = 0.020083365564211232, b1 = 0.040166731128422464, b2 = 0.020083365564211232;
        const double a1 = -1.5610180758007182, a2 = 0.6413515380575631;
        double x = numbers[GAIN] * numbers[k], out = b0 * x + z[k][0];
        z[k][0] = b1 * x - a1 * out + z[k][1];
        z[k][1] = b2 * x - a2 * out;
        numbers[OUTPUT + k] = out;
    }
"""


@pytest.fixture(scope="session")
def low_pass(compiled, tmp_path_factory):
    """Give the filter by one of the doors: ``low_pass("c") -> (spec, names of its inputs, units of 1 V, outputs)``."""

    @cache
    def low_pass(door):
        if door == "python":
            return f"{EXAMPLE / 'low_pass.py'}:LowPass", ("u_a_v", "u_b_v", "u_c_v"), 1.0, ("m_a", "m_b", "m_c")
        if door.startswith("fmi"):
            folder, version = tmp_path_factory.mktemp(door), int(door[3])
            text = fmu_sources.SOURCE.read_text("utf-8")
            assert PLAIN in text
            source = folder / "filter.c"
            source.write_text(text.replace(PLAIN, FILTER), "utf-8")
            binary = fmu_sources.compiled(folder, version, source)
            import fmpy

            place = fmpy.platform_tuple if version == 3 else fmpy.platform
            file = fmu_sources.packed(folder, fmu_sources.description(version), binary, place)
            names = [tuple(f"m_in[{k}]" for k in range(3)), tuple(f"m_out[{k}]" for k in range(3))]
            if version == 2:
                names = [("m_a", "m_b", "m_c"), ("m_a_out", "m_b_out", "m_c_out")]
            return str(file), names[0], 1 / 400, names[1]
        names = ("V_abc[0]", "V_abc[1]", "V_abc[2]"), 1e-3, ("ma", "mb", "mc")
        if door == "c":
            return str(compiled(EXAMPLE / "low_pass.c")), *names
        return f"stdio:{sys.executable} {HERE / 'low_pass_program.py'} {door}", *names

    return low_pass


@pytest.fixture
def written(tmp_path):
    """Write columns as a file: ``written("in.csv", columns, step_s=1e-4, t0_s=0) -> path``."""

    def written(name, columns, step_s=1e-4, t0_s=0.0):
        count = len(next(iter(columns.values())))
        file = tmp_path / name
        file.write_text(exact_text(t0_s + step_s * np.arange(count), columns), "utf-8")
        return file

    return written
