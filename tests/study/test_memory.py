import subprocess
import sys

import pytest

PROGRAM = """
import resource, sys
import numpy as np
from pvlvrt_compliance.study.memory import keep_freed_memory

def faults():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        [np.ones(400_000) for _ in range(12)]
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

if sys.argv[1] == "kept":
    assert keep_freed_memory() and keep_freed_memory()
faults()
print(faults())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems keep freed memory, or have no such setting")
def test_freed_memory_is_used_again():
    """Arrays that are made and freed time and again cost their pages once; without the setting, each time."""
    found = {}
    for way in ("kept", "given back"):
        run = subprocess.run([sys.executable, "-c", PROGRAM, way], capture_output=True, text=True, check=True)
        found[way] = int(run.stdout)
    assert found["kept"] < 100
    assert found["given back"] > 1000
