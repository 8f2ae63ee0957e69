"""What a Python class, an FMU and another program cost as a controller: microseconds a control step.

    python benchmarks/callback_doors.py [--calls 20000] [--repeats 7]

Needs the extra fmi and gcc. Class and FMUs hold what modulates, which costs them next to nothing: what is measured is
the door, called by compiled code as the loop over time calls it. The best of the repeats.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numba

ROOT = Path(__file__).parents[1]
DOORS = ROOT / "tests" / "controllers"
sys.path.insert(0, str(DOORS))
from fmu_sources import compiled, description, packed  # noqa: E402

from pvlvrt_compliance.controllers.doors import door_to  # noqa: E402
from pvlvrt_compliance.simulation.door.native_call import call_address  # noqa: E402
from pvlvrt_compliance.units import Nominal  # noqa: E402

MAPPING = {
    2: '[outputs]\nm_a_out = "m_a"\nm_b_out = "m_b"\nm_c_out = "m_c"\n',
    3: "".join(
        f"[{side}]\n" + "".join(f'"{port}[{k}]" = "m_{x}"\n' for k, x in enumerate("abc"))
        for side, port in (("inputs", "m_in"), ("outputs", "m_out"))
    ),
}


@numba.njit(error_model="numpy")
def call_often(address: int, argument: int, calls: int) -> int:
    """Call a function so many times; how often it failed."""
    failed = 0
    for _ in range(calls):
        if call_address(address, argument) != 0:
            failed += 1
    return failed


def cost_us(spec: str, calls: int, repeats: int) -> float:
    """Time of one control step through a door (us)."""
    door = door_to(spec, {})
    opened = door.open(Nominal())
    times = []
    try:
        for count in [10] + repeats * [calls]:
            begin = time.perf_counter()
            failed = call_often(opened.address, opened.argument, count)
            times.append(1e6 * (time.perf_counter() - begin) / count)
            assert failed == 0, door.message()
    finally:
        door.close()
    return min(times[1:])


def fmu(folder: Path, version: int) -> str:
    """FMU in C that holds what modulates."""
    place = fmpy.platform_tuple if version == 3 else fmpy.platform
    folder.mkdir()
    (folder / "small.mapping.toml").write_text(MAPPING[version], "utf-8")
    return str(packed(folder, description(version), compiled(folder, version), place))


CLASS = """
class Holding:
    sample_time_s = 40.9568e-6

    def reset(self, nominal):
        pass

    def step(self, measured):
        return measured.m_a, measured.m_b, measured.m_c
"""


def python_class(folder: Path) -> str:
    """Class that holds what modulates."""
    file = folder / "holding.py"
    file.write_text(CLASS, "utf-8")
    return f"{file}:Holding"


def c_program(folder: Path) -> str:
    """Give the example in C, compiled."""
    program = folder / "controller"
    source = ROOT / "examples" / "program-c" / "controller.c"
    subprocess.run([shutil.which("gcc") or "cc", "-O2", "-o", str(program), str(source), "-lm"], check=True)
    return f'stdio:"{program}"'


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calls", type=int, default=20000)
    parser.add_argument("--repeats", type=int, default=7)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        python = f'stdio:"{sys.executable}" "{ROOT / "examples" / "program-python" / "controller.py"}"'
        rows: list[tuple[str, Callable[[], Any]]] = [
            ("Python class (at most 15)", lambda: python_class(folder)),
            ("FMI 2, an FMU in C (at most 25)", lambda: fmu(folder / "fmi2", 2)),
            ("FMI 3, an FMU in C (at most 25)", lambda: fmu(folder / "fmi3", 3)),
            ("program in C, binary, with its controller", lambda: c_program(folder)),
            ("program in Python, JSON, with its controller", lambda: python),
        ]
        for what, make in rows:
            print(f"{what:45} {cost_us(make(), given.calls, given.repeats):8.2f} us a control step")


if __name__ == "__main__":
    main()
