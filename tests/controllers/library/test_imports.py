"""What a library takes from elsewhere, read from its file."""

import shutil
import struct
import subprocess
import sys

import pytest

from pvlvrt_compliance.controllers.library.besides import besides_of_archive, besides_of_library
from pvlvrt_compliance.controllers.library.imports import Imports, imports_of
from pvlvrt_compliance.controllers.simulator import ForeignSimulator

elf = pytest.mark.skipif(sys.platform != "linux", reason="the compiler makes other files here")


@pytest.fixture(scope="module")
def built(gcc, tmp_path_factory):
    """Build ``built(source, *flags) -> content of the library``."""

    def built(source, *flags):
        folder = tmp_path_factory.mktemp("built")
        (folder / "it.c").write_text(source)
        command = [gcc, "-shared", "-fPIC", str(folder / "it.c"), "-o", str(folder / "libit.so"), *flags]
        subprocess.run(command, check=True)
        return (folder / "libit.so").read_bytes()

    return built


SINE = "#include <math.h>\ndouble f(double x) { return sin(x) + fmod(x, 3.0); }"


@elf
def test_the_same_as_another_program_reads(built, tmp_path):
    """Libraries and functions of an ELF file are those that readelf tells."""
    readelf = shutil.which("readelf")
    if readelf is None:
        pytest.skip("readelf is missing")
    content = built(SINE, "-lm")
    (tmp_path / "lib.so").write_bytes(content)
    told = subprocess.run(
        [readelf, "-dW", "--dyn-syms", tmp_path / "lib.so"], capture_output=True, text=True, check=True
    )
    libraries = [line.partition("[")[2].rstrip("]") for line in told.stdout.splitlines() if "(NEEDED)" in line]
    functions = {
        line.split()[7].partition("@")[0]
        for line in told.stdout.splitlines()
        if " UND " in line + " " and len(line.split()) > 7
    }
    found = imports_of(content)
    assert (list(found.libraries), set(found.functions)) == (libraries, functions)
    assert {"sin", "fmod"} <= found.functions


@elf
@pytest.mark.parametrize("flags", [("-lm",), ()])
def test_mathematics_is_nothing_besides(built, flags):
    """Nor where the library was linked without saying whose sine it takes: it is the system's."""
    content = built(SINE, *flags)
    assert (besides_of_library(content), besides_of_archive(content, ())) == ("", "")


REACHING = {
    "a file": ('#include <stdio.h>\nvoid *f(void) { return fopen("gains.csv", "r"); }', "it calls fopen"),
    "the clock": ("#include <time.h>\nlong f(void) { return time(0); }", "it calls time"),
    "the environment": ('#include <stdlib.h>\nchar *f(void) { return getenv("GAIN"); }', "it calls getenv"),
    "numbers by chance": ("#include <stdlib.h>\nint f(void) { return rand(); }", "it calls rand"),
    "another library": ('#include <dlfcn.h>\nvoid *f(void) { return dlopen("x.so", 1); }', "it calls dlopen"),
    "who loads it": (
        "double gain(void);\ndouble f(void) { return gain(); }",
        "it takes gain from the program that loads it",
    ),
}


@elf
@pytest.mark.parametrize("what", REACHING)
def test_what_a_library_reaches_is_named(built, what):
    """A record may depend on it, and no digest of the library's file says so."""
    source, words = REACHING[what]
    assert besides_of_library(built(source)) == words


@elf
def test_what_an_archive_brings_is_nothing_besides(built, tmp_path):
    """Files of an FMU are in it; a library that it needs and does not bring is named."""
    assert besides_of_archive(built(REACHING["a file"][0]), ()) == ""
    assert besides_of_archive(built(REACHING["another library"][0]), ()) == "it calls dlopen"
    (tmp_path / "libgain.so").write_bytes(built("double gain(void) { return 2; }", "-Wl,-soname,libgain.so"))
    needing = built(REACHING["who loads it"][0], f"-L{tmp_path}", "-lgain")
    assert besides_of_library(needing) == "it needs libgain.so"
    assert besides_of_archive(needing, ("libother.so",)) == "it needs libgain.so"
    assert besides_of_archive(needing, ("libgain.so",)) == ""


def dll(libraries):
    """A DLL of 64 bits that is nothing but its table of imports: functions by the library that they are taken from."""
    base, offset = 0x1000, 0x200  # of its one section, in memory and in the file
    data = bytearray(20 * (len(libraries) + 1))

    def add(content):
        data.extend(content + bytes(-len(content) % 8))
        return base + len(data) - len(content) - (-len(content) % 8)

    for k, (library, functions) in enumerate(libraries.items()):
        hints = [add(b"\0\0" + name.encode() + b"\0") for name in functions]
        table = add(struct.pack(f"<{len(hints) + 2}Q", *hints, 1 << 63 | 7, 0))  # the last by its number
        struct.pack_into("<IIIII", data, 20 * k, table, 0, 0, add(library.encode() + b"\0"), table)
    optional = struct.pack("<H", 0x20B) + bytes(110) + struct.pack("<4I", 0, 0, base, len(data)) + bytes(8 * 14)
    section = struct.pack("<8s6I2HI", b".idata", len(data), base, len(data), offset, 0, 0, 0, 0, 0)
    head = b"MZ" + bytes(58) + struct.pack("<I", 64) + b"PE\0\0"
    head += struct.pack("<HHIIIHH", 0x8664, 1, 0, 0, 0, len(optional), 0x2000) + optional + section
    return head + bytes(offset - len(head)) + bytes(data)


def test_a_dll_says_what_it_takes():
    """Of Windows' files, too: libraries, and functions that are named."""
    content = dll({"KERNEL32.dll": ["Sleep"], "ucrtbase.dll": ["sin", "fopen"]})
    assert imports_of(content) == Imports(("KERNEL32.dll", "ucrtbase.dll"), frozenset({"Sleep", "sin", "fopen"}))
    assert besides_of_library(content) == "it calls fopen"
    assert besides_of_library(dll({"KERNEL32.dll": ["Sleep"], "api-ms-win-crt-math-l1-1-0.dll": ["sin"]})) == ""
    assert besides_of_library(dll({"KERNEL32.dll": [], "gain.dll": ["gain"]})) == "it needs gain.dll"


@pytest.mark.parametrize(
    "content", [b"", b"\x7fELF", b"\x7fELF\x02\x01" + bytes(90), b"\xcf\xfa\xed\xfe" + bytes(90), b"MZ"]
)
def test_what_cannot_be_told_is_said(content):
    """A file whose tables are not known, or not there, is not taken for one that needs nothing."""
    assert imports_of(content) is None
    assert besides_of_library(content) == "what it takes from elsewhere cannot be told from its file"


@elf
def test_a_controller_in_c_is_decided_by_its_file(compiled):
    """Its description says so: it takes mathematics and texts from the system, no more."""
    found = ForeignSimulator(str(compiled("parameterised.c"))).description
    assert (found.besides, found.may_be_listed) == ("", True)
