import os
import subprocess
import sys

import numpy as np
import pytest

from pvlvrt_compliance import kernel
from pvlvrt_compliance.plant.inverter import limit_modulation


def test_the_python_behind_a_kernel():
    """`plain` gives the function that was decorated, and leaves a function that was not as it is."""
    assert kernel.plain(limit_modulation).__name__ == "limit_modulation"
    assert not hasattr(kernel.plain(limit_modulation), "py_func")
    assert kernel.plain(test_the_python_behind_a_kernel) is test_the_python_behind_a_kernel


SHORT_RUN = """
import sys
import numpy as np
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.simulate import simulate

scenario = Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=0.02, before_s=0.25, after_s=0.1)
waveforms = simulate(scenario, parameters_from(["simulation.settling_s=0", *sys.argv[2:]]))
np.save(sys.argv[1], np.array(list(waveforms.segments[0].channels.values())))
"""


@pytest.mark.slow
@pytest.mark.parametrize(("precision", "tolerance"), [("double", 1e-9), ("single", 2.0**-18)])
def test_without_the_compiler_the_same_numbers_come_out(tmp_path, precision, tolerance):
    """NUMBA_DISABLE_JIT=1 runs the same kernels in Python, through a sag, to 1e-9 of the largest value.

    With 32 bits to 32 ulp, as numpy's sine and the machine's differ in the last bit.
    """
    records = []
    for disabled in ("0", "1"):
        file = tmp_path / f"{disabled}.npy"
        environment = os.environ | {"NUMBA_DISABLE_JIT": disabled}
        command = [sys.executable, "-c", SHORT_RUN, str(file), f"controller.precision={precision}"]
        subprocess.run(command, check=True, env=environment)
        records.append(np.load(file))
    compiled, interpreted = records
    scale = np.abs(compiled).max(axis=1, keepdims=True)
    assert (np.abs(compiled - interpreted) <= tolerance * scale).all()
