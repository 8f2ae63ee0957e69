"""A program that is a controller, or behaves badly: ``programs.py json|binary [how] [--listen]``.

What acts is its command, times a gain, as in small.py; badly it behaves from 0.07 s of the record on.
"""

import json
import os
import socket
import struct
import sys

PORTS = {"inputs": [{"name": "m", "width": 3}, "time_s"], "outputs": [{"name": "m", "width": 3}]}
BAD_FROM_S = 0.1


def hello(how, mode):
    """Answer to the greeting."""
    gain = {"value": 1.0, "minimum": 0.0, "maximum": 2.0}
    said = {"version": 1, "sample_time_s": 1e-4, "mode": mode, "parameters": {"gain": gain}} | PORTS
    if how == "silent":
        sys.exit(0)
    if how == "old":
        said["version"] = 0
    if how == "typo":
        said["sampel_time_s"] = 1.0
    if how == "raises":
        said["name"] = 1 / 0
    if how == "refuses":
        said = {"error": "no licence"}
    return b"Hello!\n" if how == "prints" else as_line(said)


def as_line(message):
    """Message in one line."""
    return json.dumps(message).encode() + b"\n"


def frame(numbers):
    """Packed numbers after their length."""
    return struct.pack(f"<I{len(numbers)}d", 8 * len(numbers), *numbers)


def answer(m, how, mode):
    """Answer of a program that behaves badly."""
    if how == "dies":
        sys.stderr.write("no more sense")
        sys.stderr.flush()
        os._exit(3)
    if how == "hangs":
        sys.stdin.buffer.read()  # until the other side has gone
    if how == "nan":
        m[0] = float("nan")
    if how == "huge":
        m[0] = 1e9
    if how == "garbage":
        return b"what?\n" if mode == "json" else b"what?\n" * 10
    if how == "gives-up":
        reason = "the link has lost its voltage"
        packed = struct.pack("<I", 1 << 31 | len(reason)) + reason.encode()
        return packed if mode == "binary" else as_line({"error": reason})
    if how == "no-output":
        return as_line({"n": m})
    if how == "word":
        return as_line({"m": [m[0], "high", m[2]]})
    if how == "narrow":
        return as_line({"m": m[:2]})
    good = frame(m) if mode == "binary" else as_line({"m": m})
    return {"twice": 2 * good, "half": good[:-3]}.get(how, good)


def serve(stream_in, stream_out, mode, how):
    """Answer until the end."""
    gain = 1.0

    def say(data):
        stream_out.write(data)
        stream_out.flush()

    while line := stream_in.readline():
        message = json.loads(line)
        if "protocol" in message:
            say(hello(how, mode))
        elif "start" in message:
            gain = message["start"]["parameters"]["gain"]
            say(as_line({"error": "not in this mood"} if how == "moody" else {"ready": True}))
            if mode == "binary":
                break
        elif "end" in message:
            return
        else:
            m, t = message["m"], message["time_s"]
            say(answer([gain * x for x in m], how if t >= BAD_FROM_S else "", mode))
            if how == "half" and t >= BAD_FROM_S:
                return
    while len(head := stream_in.read(4)) == 4 and head != bytes(4):
        *m, t = struct.unpack("<4d", stream_in.read(32))
        say(answer([gain * x for x in m], how if t >= BAD_FROM_S else "", mode))
        if how == "half" and t >= BAD_FROM_S:
            return


def listen(mode, how):
    """Serve one connection after the other."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        sys.stdout.write(f"{server.getsockname()[1]}\n")
        sys.stdout.flush()
        while True:
            connection, _ = server.accept()
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            with connection, connection.makefile("rb") as reader, connection.makefile("wb") as writer:
                serve(reader, writer, mode, how)


if __name__ == "__main__":
    words = [word for word in sys.argv[2:] if word != "--listen"]
    if "--listen" in sys.argv:
        listen(sys.argv[1], *words or [""])
    else:
        serve(sys.stdin.buffer, sys.stdout.buffer, sys.argv[1], *words or [""])
