"""A controller that leaves a process behind, in a session of its own, and then ends or hangs as its parameter says."""

import subprocess
from pathlib import Path


class Controller:
    """Commands nothing. The id of what it has started goes to a file."""

    def __init__(self, sample_time_s: float = 2e-4, pid_file: str = "", hangs: bool = True):
        self.sample_time_s, self.pid_file, self.hangs = sample_time_s, Path(pid_file), hangs

    def reset(self, nominal):
        """Start anew."""

    def step(self, _measurements):
        """Leave a process behind in the first call."""
        if not self.pid_file.exists():
            left = subprocess.Popen(["setsid", "sleep", "600"])
            unfinished = self.pid_file.with_suffix(".part")
            unfinished.write_text(str(left.pid))
            unfinished.rename(self.pid_file)
            while self.hangs:
                pass
        return 0.0, 0.0, 0.0
