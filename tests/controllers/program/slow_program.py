"""A program with a slow task, as slow.py has: ``slow_program.py json|binary [untied]``."""

import json
import struct
import sys

INPUTS = ["m_a", "m_b", "m_c", "slow_task_due"]
OUTPUTS = ["m_a", "m_b", "m_c", "fast", "slow", "together"]


def main(mode, is_tied):
    """Hold what modulates, and count how often each of the tasks has run."""
    inputs = INPUTS if is_tied else INPUTS[:3]
    hello = {"version": 1, "sample_time_s": 1e-4, "every": 25, "mode": mode, "inputs": inputs, "outputs": OUTPUTS}
    read, write = sys.stdin.buffer, sys.stdout.buffer
    fast = slow = together = 0

    def say(data):
        write.write(data)
        write.flush()

    def tell(message):
        say(json.dumps(message).encode() + b"\n")

    def step(m, is_due):
        nonlocal fast, slow, together
        if is_due:
            slow += 1
            together += fast % 25 == 0
        fast += 1
        return [*m, fast, slow, together]

    read.readline()
    tell(hello)
    if "end" in json.loads(read.readline()):
        return
    tell({"ready": True})
    if mode == "json":
        while "end" not in (y := json.loads(read.readline())):
            values = step([y["m_a"], y["m_b"], y["m_c"]], y.get("slow_task_due"))
            tell(dict(zip(OUTPUTS, values, strict=True)))
        return
    while int.from_bytes(read.read(4), "little"):
        *m, is_due = struct.unpack("<4d", read.read(32))
        say(struct.pack("<I6d", 48, *step(m, is_due)))


if __name__ == "__main__":
    main(sys.argv[1], "untied" not in sys.argv)
