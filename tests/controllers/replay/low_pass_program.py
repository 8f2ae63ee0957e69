"""The filter of examples/replay as a program: ``low_pass_program.py json|binary``."""

import json
import struct
import sys

B = (0.020083365564211232, 0.040166731128422464, 0.020083365564211232)
A = (-1.5610180758007182, 0.6413515380575631)
PORTS = {
    "inputs": [{"name": "V_abc", "width": 3, "unit": "kV"}],
    "outputs": ["ma", "mb", "mc", {"name": "two", "width": 2}],
}


def say(message):
    """Answer in one line."""
    sys.stdout.buffer.write(json.dumps(message).encode() + b"\n")
    sys.stdout.buffer.flush()


def filtered(x, state):
    """One sample of one phase."""
    out = B[0] * x + state[0]
    state[0] = B[1] * x - A[0] * out + state[1]
    state[1] = B[2] * x - A[1] * out
    return out


def main(mode):
    """Serve one run."""
    states, gain = [[0.0, 0.0] for _ in range(3)], 1.0
    for line in iter(sys.stdin.buffer.readline, b""):
        message = json.loads(line)
        if "protocol" in message:
            say({"version": 1, "sample_time_s": 1e-4, "mode": mode, "parameters": {"gain": 1.0}} | PORTS)
        elif "start" in message:
            gain = message["start"]["parameters"]["gain"]
            say({"ready": True})
            if mode == "binary":
                break
        elif "end" in message:
            return
        else:
            out = [filtered(gain * x / 0.4, state) for x, state in zip(message["V_abc"], states, strict=True)]
            say(dict(zip(("ma", "mb", "mc"), out, strict=True)) | {"two": out[:2]})
    while len(head := sys.stdin.buffer.read(4)) == 4 and head != bytes(4):
        inputs = struct.unpack("<3d", sys.stdin.buffer.read(24))
        out = [filtered(gain * x / 0.4, state) for x, state in zip(inputs, states, strict=True)]
        sys.stdout.buffer.write(struct.pack("<I5d", 40, *out, *out[:2]))
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main(sys.argv[1])
