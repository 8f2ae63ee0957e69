"""Bytes to another program and back: over pipes to one that is started here, or over TCP to one that runs."""

import os
import shlex
import shutil
import socket
import struct
import subprocess
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.ordinary_file import is_there
from pvlvrt_compliance.texts import shortened

STDIO, TCP = "stdio:", "tcp://"
"""How the two are written."""

_SHOWN = 200  # characters of a name
_AT_ONCE = 1 << 16
_LONGEST_LINE = 1 << 20
_LONGEST_REASON = 4096
_LENGTH = struct.Struct("<I")
GIVES_UP = 1 << 31
"""In the length of a frame: a text of so many bytes follows, why the program gives up."""

_PATIENCE_S = 1.0  # with a program that is to end


class Link(Protocol):
    """Two streams of bytes."""

    def write(self, data: bytes | memoryview) -> None:
        """Send bytes, all of them."""

    def read(self) -> bytes:
        """Take what is there, at least a byte; nothing when the other side has ended."""

    def cut(self) -> None:
        """Make a `read` that waits in another thread end."""

    def close(self) -> None:
        """End the link, and what was started for it."""

    def farewell(self) -> str:
        """What became of the other side, in words."""


class Pipes:
    """Link to a program that is started for it, without a shell; what it writes to stderr goes where ours goes."""

    def __init__(self, arguments: list[str]) -> None:
        try:
            self._process = subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or error
            raise DoorError(f"{shortened(arguments[0], _SHOWN)} cannot be started: {why}") from None
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._to, self._from = self._process.stdin.fileno(), self._process.stdout.fileno()

    def write(self, data: bytes | memoryview) -> None:
        """Send bytes, all of them."""
        while len(data) > (sent := os.write(self._to, data)):
            data = data[sent:]

    def read(self) -> bytes:
        """Take what is there."""
        return os.read(self._from, _AT_ONCE)

    def cut(self) -> None:
        """Kill the program: its end of the pipe closes."""
        self._process.kill()

    def close(self) -> None:
        """Close the pipes, and kill the program if it does not end by itself."""
        process = self._process
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                with suppress(OSError):
                    stream.close()
        try:
            process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def farewell(self) -> str:
        """How the program ended."""
        try:
            status = self._process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            return "the program has closed its output"
        return f"the program was ended by signal {-status}" if status < 0 else f"the program ended with status {status}"


class Connection:
    """Link to a program that listens."""

    def __init__(self, host: str, port: int, timeout_s: float) -> None:
        try:
            self._socket = socket.create_connection((host, port), timeout_s)
        except (OSError, ValueError) as error:  # a name that no host can have is no `OSError`
            raise DoorError(f"nothing answers at {shortened(host, _SHOWN)}, port {port}: {error}") from None
        self._socket.settimeout(None)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.write, self._receive = self._socket.sendall, self._socket.recv

    def read(self) -> bytes:
        """Take what is there."""
        return self._receive(_AT_ONCE)

    def cut(self) -> None:
        """Shut the connection down."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close the connection; the program may go on."""
        self._socket.close()

    def farewell(self) -> str:
        """What became of the other side."""
        return "the program has closed the connection"


def link_to(spec: str, timeout_s: float) -> Link:
    """Start or connect what ``stdio:COMMAND`` or ``tcp://HOST:PORT`` names.

    Raises
    ------
    DoorError
        When that cannot be done.
    """
    if spec.startswith(STDIO):
        return Pipes(command_of(spec))
    host, _, port = spec.removeprefix(TCP).rpartition(":")
    if not (host and port.isdecimal() and len(port) < 6 and 0 < int(port) < 1 << 16):
        raise DoorError("write tcp://HOST:PORT, for instance tcp://127.0.0.1:5000")
    return Connection(host.strip("[]"), int(port), timeout_s)


def command_of(spec: str) -> list[str]:
    """Words of the command in ``stdio:COMMAND``.

    Raises
    ------
    DoorError
        When there are none, or a quote does not end.
    """
    try:
        words = shlex.split(spec.removeprefix(STDIO), posix=os.name != "nt")
    except ValueError as error:
        raise DoorError(f"{spec.removeprefix('stdio:')!r} is not a command: {error}") from None
    if not words:
        raise DoorError("write stdio:COMMAND, for instance 'stdio:python3 my_ctrl.py'")
    return words


def files_of(command: list[str]) -> list[Path]:
    """Files that a command names: the program, and arguments that are files."""
    program = shutil.which(command[0])
    return [Path(word) for word in ([program] if program else []) + command[1:] if is_there(Path(word))]


class Conversation:
    """Messages over a link, with a limit to how long an answer may take.

    Parameters
    ----------
    timeout_s : float
        For an answer (s); may be changed between two.

    Raises
    ------
    DoorError
        By what waits: when the other side ends, is late, or sends what is no message.
    """

    def __init__(self, link: Link, timeout_s: float) -> None:
        self._link = link
        self.timeout_s = timeout_s
        self._since: float | None = None
        self._late = False
        self._over = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    def tell(self, message: bytes | memoryview) -> None:
        """Send a message."""
        self._since = time.monotonic()
        try:
            self._link.write(message)
        except OSError as error:
            raise DoorError(self._farewell() or str(error)) from None

    def line(self) -> bytes:
        """Take the one line that answers the last message."""
        data = self._more()
        while b"\n" not in data:
            if len(data) > _LONGEST_LINE:
                raise DoorError(f"the program does not end its line; it begins with {data[:60]!r}")
            data += self._more()
        self._since = None
        line, _, rest = data.partition(b"\n")
        if rest:
            raise DoorError(f"the program sent more than the one line that was asked for: {rest[:60]!r}")
        return line

    def frame(self, head: bytes, size: int) -> bytes:
        """Take the frame that answers the last message: the head that it must have, and so many bytes.

        Raises
        ------
        DoorError
            When it is another, with the reason that a program may give in its place.
        """
        data = self._more()
        while len(data) < size + len(head) and data[: len(head)] == head[: len(data)]:
            data += self._more()
        if len(data) != size + len(head) or data[: len(head)] != head:
            raise DoorError(self._refusal(data, size))
        self._since = None
        return data[len(head) :]

    def end(self, farewell: bytes) -> None:
        """Send a last message and close the link; whatever fails."""
        self._over.set()
        with suppress(OSError):
            self._link.write(farewell)
        self._link.close()

    def _refusal(self, data: bytes, size: int) -> str:
        """What is wrong with a frame."""
        while len(data) < _LENGTH.size:
            data += self._more()
        (length,) = _LENGTH.unpack_from(data)
        if length & GIVES_UP and (length := length ^ GIVES_UP) <= _LONGEST_REASON:
            while len(data) < _LENGTH.size + length:
                data += self._more()
            return f"the program gave up: {data[_LENGTH.size :].decode('utf-8', 'replace')}"
        if length == size:
            return f"the program sent {len(data) - size - _LENGTH.size} bytes more than one frame"
        return f"the program sent a frame of {length} bytes, beginning with {data[:20]!r}; {size} are due"

    def _more(self) -> bytes:
        try:
            data = self._link.read()
        except OSError:
            data = b""
        if not data:
            raise DoorError(self._farewell())
        return data

    def _farewell(self) -> str:
        if self._late:
            return f"the program did not answer within {self.timeout_s:g} s"
        return self._link.farewell()

    def _watch(self) -> None:
        while not self._over.wait(min(self.timeout_s / 4, 1.0)):
            since = self._since
            if since is not None and time.monotonic() - since > self.timeout_s:
                self._late = True
                self._link.cut()
                return
