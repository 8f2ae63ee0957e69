"""Controllers that do harm once, in the first sag below 0.6 pu, by name and door; without such a sag all are well.

Each is to cost its own test, which is an `error` with the words of `Evil.expected` in its message, and nothing else.
"""

import shutil
import subprocess
import sys
import textwrap
import zipfile
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from evil_sources import LIBRARY, LIBRARY_DEEDS, PROGRAM, PYTHON, PYTHON_DEEDS
from pvlvrt_compliance.controllers.library import HEADER

BELOW_PU = 0.6
"""Voltage below which the deed is done (pu): a sag of more than 40 %."""

LOW = (
    "simulation.memory_limit_mb=500",
    "simulation.output_limit_mb=2",
    "simulation.files_limit_mb=20",
    "simulation.files_limit=500",
    "simulation.processes_limit=20",
    "simulation.settling_s=0.2",
)
"""What to set (``--set``) for each; of time there is enough, but for those that stop at nothing else."""


@dataclass(frozen=True)
class Evil:
    """A controller that does harm.

    Parameters
    ----------
    door : str
        ``python``, ``library``, ``program`` or ``fmu``.
    files : mapping
        Texts by the names of the files that it is made of.
    expected : str
        Words in the message of the test's error; empty where either end is right: it does no harm, or is an error.
    mapping : str or None
        Name of its mapping file, one of ``files``.
    make : callable, optional
        Makes, in a folder with ``files``, what is no text.
    at_opening : bool
        Whether it is refused before any test, with these words (status 2).
    """

    door: str
    files: Mapping[str, str]
    expected: str
    mapping: str | None = None
    make: Callable[[Path], None] | None = None
    at_opening: bool = False
    more: tuple[str, ...] = ()  # further assignments of --set

    @property
    def settings(self) -> tuple[str, ...]:
        """Assignments of ``--set`` by which it comes to its end within seconds."""
        patient = ("controller.reply_timeout_s=300",) if self.door == "program" else ()  # on a busy machine
        return (*LOW, *patient, *(("simulation.time_limit_s=3",) if "time_limit" in self.expected else ()), *self.more)

    @property
    def needs_compiler(self) -> bool:
        """Whether gcc is needed."""
        return self.door == "library"

    def build(self, folder: Path) -> str:
        """Write and make it in a folder; its specification, what stands after ``--controller``."""
        for name, text in self.files.items():
            (folder / name).write_text(text, "utf-8")
        if self.make is not None:
            self.make(folder)
        file = (
            folder / {"python": "evil.py", "library": "libevil.so", "program": "evil.py", "fmu": "evil.fmu"}[self.door]
        )
        return {"python": f"{file}:Controller", "program": f"stdio:{sys.executable} {file}"}.get(self.door, str(file))


def compile_library(folder: Path) -> None:
    """Build ``libevil.so`` of ``evil.c``."""
    gcc = shutil.which("gcc")
    assert gcc is not None
    flags = ["-std=gnu99", "-O1", "-w", "-shared", "-fPIC", f"-I{HEADER.parent}"]
    subprocess.run([gcc, *flags, folder / "evil.c", "-o", folder / "libevil.so", "-lm"], check=True)


def _python(deed: str, expected: str) -> Evil:
    return Evil("python", {"evil.py": PYTHON.format(deed=_function(deed), below=BELOW_PU)}, expected)


def _program(deed: str, expected: str) -> Evil:
    return Evil(
        "program", {"evil.py": PROGRAM.replace("{deed}", _function(deed)).replace("{below}", str(BELOW_PU))}, expected
    )


def _function(deed: str) -> str:
    return "def deed():\n" + textwrap.indent(PYTHON_DEEDS[deed], "    ")


def _library(deed: str, expected: str) -> Evil:
    text = LIBRARY % {"deed": LIBRARY_DEEDS[deed], "below": BELOW_PU}
    return Evil("library", {"evil.c": text}, expected, make=compile_library)


def _archive(*entries: tuple[zipfile.ZipInfo | str, bytes]) -> Callable[[Path], None]:
    def make(folder: Path) -> None:
        with zipfile.ZipFile(folder / "evil.fmu", "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in entries:
                archive.writestr(name, content)

    return make


def _bomb(folder: Path) -> None:
    """Some 2 MB that unpack to 2 GB: one piece of zeros, compressed once, two thousand times over."""
    squeeze = zlib.compressobj(9, zlib.DEFLATED, -15)
    piece = squeeze.compress(bytes(1 << 20)) + squeeze.flush(zlib.Z_FULL_FLUSH)
    end = zlib.compressobj(9, zlib.DEFLATED, -15).flush()
    entry = zipfile.ZipInfo("resources/table.bin")
    entry.compress_type, entry.CRC = zipfile.ZIP_DEFLATED, 0  # which nobody comes to compare
    entry.header_offset = 0
    entry.file_size, entry.compress_size = 2000 << 20, 2000 * len(piece) + len(end)
    with (folder / "evil.fmu").open("wb") as file, zipfile.ZipFile(file, "w") as archive:
        file.write(entry.FileHeader())
        file.write(2000 * piece + end)
        archive.filelist.append(entry)
        archive.start_dir = file.tell()
        archive._didModify = True


def _link() -> zipfile.ZipInfo:
    link = zipfile.ZipInfo("resources/gains")
    link.external_attr = 0o120777 << 16
    return link


def _fmu(make: Callable[[Path], None], expected: str) -> Evil:
    return Evil("fmu", {}, expected, make=make, at_opening=True)


EVIL: dict[str, Evil] = {
    f"{name}, {kind.__name__.removeprefix('_')}": kind(name, words)
    for name, kinds, words in (
        ("exits", (_python, _library), "the controller ended the process (status 0)"),
        ("exits", (_program,), "the program ended with status 0"),
        ("dies", (_python,), "the controller crashed (SIGKILL"),
        ("dies", (_program,), "the program was ended by signal 9"),
        ("crashes", (_library,), "the controller crashed (SIGSEGV)"),
        ("loops", (_python, _library, _program), "simulation.time_limit_s"),
        ("stops itself", (_python, _library), "has been stopped (SIGSTOP)"),
        ("stops itself", (_program,), "has been stopped (SIGSTOP)"),
        ("stops its parent", (_python, _library, _program), "stopped (SIGSTOP)"),
        ("kills its parent", (_python, _library), "the process for the controller has ended"),
        ("kills its parent", (_program,), "the controller crashed (SIGKILL"),
        ("eats memory", (_python, _library, _program), "simulation.memory_limit_mb"),
        ("eats memory in a child", (_python, _program), "simulation.memory_limit_mb"),
        ("prints without end", (_python, _library, _program), "simulation.output_limit_mb"),
        ("prints 100 MB", (_python, _program), "simulation.output_limit_mb"),
        ("starts processes", (_python, _library, _program), "simulation.processes_limit"),
        ("leaves processes", (_python,), "the controller ended the process (status 4)"),
        ("writes a big file", (_python, _program), "simulation.files_limit_mb"),
        ("writes many files", (_python, _program), "simulation.files_limit"),
        ("removes its folder", (_python, _program), "was removed"),
        ("locks its folder", (_python,), "the controller ended the process (status 3)"),
        ("long message", (_python,), "ValueError: xxx"),
        ("long message", (_library,), "simulation.output_limit_mb"),
        ("forks and goes on", (_python, _library, _program), ""),
        ("forges an answer", (_python,), "its answer cannot be used"),
        ("forges with a pickle", (_python,), "its answer cannot be used"),
        ("forges no JSON", (_python,), "its answer cannot be used"),
        ("forges a deep answer", (_python,), "its answer cannot be used"),
        ("forges a long answer", (_python,), "simulation.files_limit_mb"),
        ("forges with a pipe", (_python,), "its answer cannot be used"),
        ("forges with a link", (_python,), "its answer cannot be used"),
        ("spoils its progress", (_python,), "the controller ended the process (status 0)"),
        ("speaks to its parent's reader", (_python,), "has written into a pipe"),
        ("answers then dies", (_python,), "the controller crashed (SIGSEGV)"),
        ("closes all files", (_python, _program), ""),
        ("smashes its heap", (_library,), "the controller crashed"),
        ("frees what is not its own", (_library,), "the controller crashed"),
        ("says more than one line", (_program,), "more than the one line"),
        ("says one endless line", (_program,), "does not end its line"),
    )
    for kind in kinds
} | {
    "unpacks to 2 GB, fmu": _fmu(_bomb, "simulation.files_limit_mb"),
    "unpacks to many files, fmu": _fmu(
        _archive(*((f"resources/{k}", b"") for k in range(2000))), "simulation.files_limit"
    ),
    "leaves its folder, fmu": _fmu(_archive(("../../evil.txt", b"x")), "../../evil.txt"),
    "brings a link, fmu": _fmu(_archive((_link(), b"/etc/passwd")), "resources/gains"),
    "has no description, fmu": _fmu(_archive(("resources/x", b"")), "is not an FMU"),
    "is no archive, fmu": Evil("fmu", {"evil.fmu": "PK no archive"}, "is not an FMU", at_opening=True),
}
"""All of them, by name and door."""
