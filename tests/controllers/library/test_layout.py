"""Structures of the interface: what Python makes of them is what the C compiler makes of them."""

import ctypes
import random
import subprocess

import pytest

from pvlvrt_compliance.controllers.library.layout import (
    Instance,
    Member,
    ModelInfo,
    ParameterStructure,
    SignalInfo,
    layout_of,
    one_after_another,
)

pytestmark = pytest.mark.compiler

STRUCTURES = {
    "Signal": SignalInfo,
    "Parameter": ParameterStructure,
    "Model_Info": ModelInfo,
    "Instance": Instance,
}
IN_C = ("", "char_T", "int8_T", "uint8_T", "int16_T", "uint16_T", "int32_T", "uint32_T", "real32_T", "real64_T")
IN_C = (*IN_C, "char_T *")


def numbers_from(gcc, header, folder, statements):
    """Compile a program that prints numbers, and run it."""
    source, program = folder / "program.c", folder / "program"
    body = "\n".join(statements)
    source.write_text(
        f'#include <stddef.h>\n#include <stdio.h>\n#include "ieee_cigre.h"\nint main(void) {{\n{body}\nreturn 0; }}\n'
    )
    subprocess.run([gcc, "-std=c99", "-Werror", f"-I{header.parent}", str(source), "-o", str(program)], check=True)
    return [int(line) for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()]


def show(expression):
    """Statement that prints a number."""
    return f'printf("%zu\\n", (size_t)({expression}));'


def test_structures_of_the_interface(gcc, header, tmp_path):
    """Every member of every fixed structure is where our header has it."""
    expected, statements = [], []
    for name, structure in STRUCTURES.items():
        in_c = f"IEEE_Cigre_DLLInterface_{name}"
        expected += [ctypes.sizeof(structure), *(getattr(structure, field[0]).offset for field in structure._fields_)]
        statements += [show(f"sizeof({in_c})"), *(show(f"offsetof({in_c}, {f[0]})") for f in structure._fields_)]
    assert numbers_from(gcc, header, tmp_path, statements) == expected


def test_sizes_that_the_interface_demands():
    """On 64 bits a signal has 32 bytes, a parameter 64, the description 160, an instance 80."""
    assert [ctypes.sizeof(structure) for structure in STRUCTURES.values()] == [32, 64, 160, 80]


def test_any_ports_lie_as_in_c(gcc, header, tmp_path):
    """Members of mixed types, arrays and texts lie where gcc puts them."""
    draw = random.Random(958)
    cases = [
        [Member(draw.randint(1, 10), draw.choice((1, 1, 1, 2, 3, 7))) for _ in range(draw.randint(1, 15))]
        for _ in range(60)
    ]
    cases.append([Member(9), Member(6), Member(4), Member(4), Member(1), Member(8), Member(10), Member(9)])
    expected, statements = [], []
    for k, members in enumerate(cases):
        layout = layout_of(members)
        expected += [layout.size, *layout.offsets]
        fields = " ".join(f"{IN_C[m.kind]} m{n}{f'[{m.width}]' if m.width > 1 else ''};" for n, m in enumerate(members))
        statements.append(f"typedef struct {{ {fields} }} S{k};")
        statements += [show(f"sizeof(S{k})"), *(show(f"offsetof(S{k}, m{n})") for n in range(len(members)))]
    assert numbers_from(gcc, header, tmp_path, statements) == expected


def test_parts_of_the_memory_begin_aligned():
    """Parts follow one another without overlap, each at a multiple of 16 bytes."""
    assert one_after_another([80, 1, 0, 17, 16]) == ((0, 80, 96, 96, 128), 144)


@pytest.mark.parametrize("language", ["c", "c++"])
def test_header_compiles_alone(gcc, header, tmp_path, language):
    """The header is valid C99 and C++, included twice, without a warning."""
    source = tmp_path / "twice.txt"
    source.write_text(
        '#include "ieee_cigre.h"\n#include "ieee_cigre.h"\nint main(void) { return Model_PrintInfo(); }\n'
    )
    standard = "c99" if language == "c" else "c++11"
    command = [gcc, "-x", language, f"-std={standard}", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only"]
    try:
        subprocess.run([*command, f"-I{header.parent}", str(source)], check=True, capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        if "cc1plus" in error.stderr:
            pytest.skip("gcc has no C++ here")
        raise
