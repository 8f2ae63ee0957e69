"""A controller whose parameters are of every type; run by itself, a program that says that it has the same."""

import json
import sys


class Parameterised:
    """It keeps what it is given."""

    sample_time_s = 1e-4

    def __init__(self, gain=1.0, status=0, softly=False, word="slow"):
        self.given = {"gain": gain, "status": status, "softly": softly, "word": word}

    def reset(self, nominal):
        """Nothing is kept."""

    def step(self, y):
        """Hold what is."""
        return y.m_a, y.m_b, y.m_c


def limited(value, maximum):
    """A parameter with a range from 0."""
    return {"value": value, "minimum": 0, "maximum": maximum}


if __name__ == "__main__":
    parameters = {"gain": limited(1.0, 2), "status": limited(0, 6), "softly": False, "word": "slow"}
    sys.stdin.readline()
    sys.stdout.write(json.dumps({"version": 1, "sample_time_s": 1e-4, "parameters": parameters}) + "\n")
    sys.stdout.flush()
    sys.stdin.readline()
