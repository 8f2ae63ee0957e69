"""How many cores this process may use."""

import math
import os
from contextlib import suppress
from pathlib import Path

_GROUPS = Path("/sys/fs/cgroup")
_OWN_GROUP = Path("/proc/self/cgroup")


def usable_cores() -> int:
    """Cores of this machine that this process may run on, and is given time on; at least one.

    A container, a CI service or a scheduler bounds both: the cores by the affinity of the process, the time by the
    quota of its control group and of those that this is in (Linux, version 2).
    """
    affinity = getattr(os, "sched_getaffinity", None)
    cores = len(affinity(0)) if affinity else os.cpu_count() or 1
    return max(1, min([cores, *map(math.ceil, _quotas())]))


def _quotas() -> list[float]:
    """Cores' worth of time that each group gives that this process is in."""
    found = []
    with suppress(OSError, ValueError):
        _, _, name = _OWN_GROUP.read_text("utf-8").splitlines()[0].partition("::")
        group = _GROUPS / name.lstrip("/")
        for place in (group, *group.parents):
            with suppress(OSError, ValueError):
                quota, period = (place / "cpu.max").read_text("ascii").split()
                found.append(float(quota) / float(period))  # ValueError: "max", which is none
            if place == _GROUPS:
                break
    return found
