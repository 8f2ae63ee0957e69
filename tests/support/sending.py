"""A controller behind each door that sends the worst text wherever it may: names, units, descriptions, errors."""

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from fmu_sources import SOURCE, compiled, description, packed

from worst import IN_C, IN_XML, WORST

_TESTS = Path(__file__).parents[1]
_LIBRARY = _TESTS / "controllers" / "library" / "misbehaving.c"

_PYTHON = f"""
import sys

WORST = {WORST!a}


class Controller:
    sample_time_s = 1e-4

    def __init__(self, deed="", note=WORST):
        self.deed, self.note = deed, note
        if deed == "make":
            raise ValueError(WORST)

    def reset(self, nominal):
        print(WORST)

    def step(self, y):
        if self.deed == "raise":
            raise RuntimeError(WORST)
        return y.m_a, y.m_b, y.m_c
"""

_PROGRAM = f"""
import json, sys

WORST = {WORST!a}
TEXT = {IN_C!a} + 5000 * "y"  # JSON of this kind has no halves of letters
deed = sys.argv[1]


def tell(message):
    sys.stdout.write(json.dumps(message) + "\\n")
    sys.stdout.flush()


sys.stderr.buffer.write(WORST.encode("utf-8", "replace") + b"\\xff\\n")
sys.stderr.flush()
sys.stdin.readline()
port = {{"unit": TEXT, "description": TEXT}}
names = ("m_a", "m_b", "m_c")
hello = {{"version": 1, "sample_time_s": 1e-4, "name": TEXT, "parameters": {{TEXT: {{"value": TEXT, **port}}}}}}
hello["inputs"] = [{{"name": name, "description": TEXT}} for name in names] + [{{"name": TEXT, **port}}, "time_s"]
hello["outputs"] = [{{"name": name, "description": TEXT}} for name in names]
tell({{"error": WORST}} if deed == "make" else {{**hello, WORST: 1}} if deed == "hello" else hello)
for line in sys.stdin:
    tell({{"ready": True}} if deed == "run" else {{"error": WORST}})
"""


class Sends(NamedTuple):
    """A controller that sends texts."""

    shown: tuple[str, ...]  # arguments of `controllers inspect`, where it says what it is
    refused: tuple[str, ...] | None  # of the same, where it says why it cannot be opened
    failing: tuple[str, ...]  # of the main command, where it gives up, or something ends it, and it has said why


def _python(folder: Path) -> Sends:
    file = folder / "controller.py"
    file.write_text(_PYTHON, "utf-8")
    spec = f"{file}:Controller"
    deed = "controller.deed="
    return Sends((spec,), (spec, "--set", f"{deed}make"), ("--controller", spec, "--set", f"{deed}raise"))


def _program(folder: Path) -> Sends:
    file = folder / "program.py"
    file.write_text(_PROGRAM, "utf-8")
    spec = f'stdio:"{sys.executable}" "{file}"'
    return Sends((f"{spec} run",), (f"{spec} hello",), ("--controller", f"{spec} raise"))


def _library(folder: Path) -> Sends:
    from shutil import which
    from subprocess import run

    from pytest import skip  # noqa: PT013 - as its neighbours' fixtures do

    from pvlvrt_compliance.controllers.library import HEADER

    compiler = which("gcc") or skip("no C compiler")
    worst = _c_text(IN_C)
    source = _LIBRARY.read_text("utf-8")
    source = source.replace('.ModelName = "misbehaving"', f".ModelName = {worst}, .ModelVersion = {worst}")
    source = source.replace('{name, "", unit,', f"{{name, {worst}, unit,").replace(
        'REAL("calls", "")', f'REAL("calls", {worst})'
    )
    source = source.replace('"", "", "s",', f'"", {worst}, {worst},')
    source = source.replace('"the current measurement is implausible"', worst).replace('"the limiter is active"', worst)
    source = source.replace('"nobody asked for this\\n"', f'"%s", {worst}')
    source = source.replace(
        "    (void)instance;\n    return", f'    (void)instance;\n    printf("%s\\n", {worst});\n    return', 1
    )
    file = folder / "sends.c"
    file.write_text(source, "utf-8")
    library = folder / "libsends.so"
    run([compiler, "-shared", "-fPIC", f"-I{HEADER.parent}", str(file), "-o", str(library), "-lm"], check=True)
    (folder / "libsends.mapping.toml").write_text('[outputs]\ncalls = { record = "calls" }\n', "utf-8")
    how = ("--set", "controller.how=5", "--set", "controller.at_s=0")
    return Sends((str(library),), None, ("--controller", str(library), *how))


def _fmu(folder: Path) -> Sends:
    source = SOURCE.read_text("utf-8")
    worst = _c_text(IN_C)
    own = folder / "source.c"
    own.write_text(source.replace('"limit %d reached by %s", 42, "the link"', f'"%s", {worst}'), "utf-8")
    text = description(2).replace('modelName="small" version="1.2"', f"modelName={_xml(IN_XML)} version={_xml(IN_XML)}")
    for name in ("m_a", "m_a_out", "gain"):
        text = text.replace(f'name="{name}"', f'name="{name}" description={_xml(IN_XML)}')
    file = packed(folder, text, compiled(folder, 2, own), "linux64")
    mapping = "".join(f'm_{phase}_out = "m_{phase}"\n' for phase in "abc")
    (folder / "small.mapping.toml").write_text(f"[outputs]\n{mapping}", "utf-8")
    how = ("--set", "controller.status=3", "--set", "controller.fail_at_s=0")
    return Sends((str(file),), (str(file), "--set", f"controller.gain={IN_C}"), ("--controller", str(file), *how))


def _c_text(text: str) -> str:
    """A text of C, with every byte that is no plain letter by its number."""
    return '"' + "".join(f"\\{byte:03o}" for byte in text.encode("utf-8", "surrogatepass")) + '"'


def _xml(text: str) -> str:
    """An attribute of XML; references keep ends of lines."""
    return quoteattr(text, {"\n": "&#10;", "\r": "&#13;", "\u2028": "&#x2028;"})


DOORS: Mapping[str, Callable[[Path], Sends]] = {
    "fmu": _fmu,
    "library": _library,
    "program": _program,
    "python": _python,
}
"""By the folder of the door."""
