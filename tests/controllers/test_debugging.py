"""A controller under a debugger, with coverage and with a sanitiser: --debug, tried with the tools themselves."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from consoles import surroundings
from pvlvrt_compliance.controllers.library import HEADER
from waiting import PATIENCE_S

SOURCE = Path(__file__).with_name("library") / "commanding.c"
COMMAND = (sys.executable, "-m", "pvlvrt_compliance", "--profile", "iec61400-21", "--sag", "0%", "--duration", "100ms")
QUICK = ("--set", "simulation.settling_s=0.1", "--waveforms", "none")
SAID = "debug: the controller runs in this process: no limit holds"

COUNTING = """
import atexit
import pathlib

calls = 0


def tell():
    pathlib.Path("calls").write_text(str(calls))


class Counting:
    sample_time_s = 1e-4

    def __init__(self, stop_at: int = 0):
        self.stop_at = stop_at

    def reset(self, nominal):
        global calls
        calls = 0
        atexit.register(tell)

    def step(self, y):
        global calls
        calls += 1
        if calls == self.stop_at:
            breakpoint()
        return y.m_a, y.m_b, y.m_c
"""


@pytest.fixture
def folder(tmp_path):
    """A folder with a controller in Python."""
    (tmp_path / "counting.py").write_text(COUNTING)
    return tmp_path


def run(folder, *arguments, before=(), given="", **environment):
    """Run a command in a folder, with lines on its stdin: (status, out, err)."""
    done = subprocess.run(
        [*before, *COMMAND, *QUICK, *arguments],
        cwd=folder,
        env=surroundings(environment),
        input=given,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr


STOPPING = ("--controller", "counting.py:Counting", "--set", "controller.stop_at=42", "--debug")


def test_a_breakpoint_reads_what_is_piped_in(folder):
    """It stops at its sample, shows what is there, and the run goes on to its verdict."""
    status, out, err = run(folder, *STOPPING, given="p calls\np 'V' if 700 < y.v_dc_v < 900 else y\nc\n")
    assert "(Pdb) 42\n(Pdb) 'V'\n" in out
    assert "ride_through" in out
    assert SAID in err
    assert status in (0, 1, 3)
    assert (folder / "pvlvrt-report" / "results.json").is_file()


def test_leaving_the_debugger_ends_the_run(folder):
    """As Ctrl-C does, with nothing for an error of the controller."""
    status, out, err = run(folder, *STOPPING, given="q\n")
    assert status == 130
    assert err.endswith("interrupted; 0 of 1 tests were finished, nothing was written\n")
    assert "step() failed" not in out + err


def test_a_breakpoint_at_a_terminal(folder):
    """No bar is drawn over its lines; stdin is the terminal's."""
    reader, terminal = pytest.importorskip("pty").openpty()
    process = subprocess.Popen(
        [*COMMAND, *QUICK, *STOPPING],
        cwd=folder,
        env=surroundings({"TERM": "xterm", "COLUMNS": "80"}),
        stdin=terminal,
        stdout=terminal,
        stderr=terminal,
        start_new_session=True,
    )
    os.close(terminal)
    seen = read_until(reader, b"(Pdb) ")
    os.write(reader, b"p calls\n")
    seen += read_until(reader, b"42\r\n(Pdb) ")
    os.write(reader, b"c\n")
    seen += read_until(reader, b"report.html")
    assert process.wait(PATIENCE_S) in (0, 1, 3)
    os.close(reader)
    assert SAID.split(":")[1].strip() in " ".join(seen.decode().split())
    assert b"preparing the simulator" not in seen


def read_until(reader, end):
    """What a terminal shows until something has come."""
    seen = b""
    while end not in seen:
        seen += os.read(reader, 4096)
    return seen


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--debug",), "--debug is for a controller of your own; it needs --controller"),
        (
            (*STOPPING, "--cluster", "local"),
            "--debug runs the controller in the process of the command; it does not go",
        ),
        ((*STOPPING, "--jobs", "many"), "--jobs many: give how many tests are run at once"),
    ],
)
def test_what_does_not_go_with_it(folder, arguments, says):
    """It is refused, with the reason."""
    status, _, err = run(folder, *arguments)
    assert status == 2
    assert says in err


def test_no_record_is_reused_and_no_process_is_begun(folder):
    """Whatever is asked for: the controller is called each time."""
    (folder / "counting.mapping.toml").write_text('files = ["counting.py"]\n')
    for _ in range(2):
        status, out, err = run(folder, *STOPPING, "--reuse", "kept", "--jobs", "4", given="p calls\nc\n")
        assert "(Pdb) 42\n" in out
        assert "one test at a time (jobs 1), no progress bar, no record is reused" in err
        assert "processes were asked for" not in err
        assert status in (0, 1, 3)
    assert not [*(folder / "kept").rglob("*")]


def build(gcc, folder, flags, change=lambda text: text):
    """Build a controller in C as somebody who looks for an error does; its source lies beside it."""
    (folder / "own.c").write_text(change(SOURCE.read_text("utf-8")))
    shutil.copy(HEADER, folder)
    command = [gcc, "-O0", "-g", "-std=c99", "-fPIC", "-shared", *flags, "own.c", "-o", "libown.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)


OWN = ("--controller", "./libown.so", "--debug")


@pytest.mark.compiler
def test_gcov_counts_every_call(gcc, folder):
    """As many of the library as of a class in Python that is called as often; the data are written at the end."""
    build(gcc, folder, ["--coverage"])
    run(folder, *OWN)
    subprocess.run(["gcov", "libown.so-own.gcda"], cwd=folder, check=True, capture_output=True)
    lines = (folder / "own.c.gcov").read_text("utf-8").splitlines()
    (counted,) = (line.split(":")[0].strip() for line in lines if "int32_T Model_Outputs(" in line)
    run(folder, "--controller", "counting.py:Counting", "--debug")
    assert int(counted) == int((folder / "calls").read_text()) > 1000


def overflowing(text):
    """The source with a write behind what it has allocated."""
    begin = "    Out *out = instance->ExternalOutputs;\n    const double"
    assert text.count(begin) == 1
    wrong = "    double *own = malloc(8 * sizeof *own);\n    own[8] = in->t;\n    free(own);\n"
    return text.replace(begin, f"{wrong}{begin}").replace("#include <math.h>", "#include <math.h>\n#include <stdlib.h>")


@pytest.mark.compiler
def test_a_heap_overflow_is_reported_with_its_line(gcc, folder):
    """By the sanitiser, as its first frame; without the overflow the run is as always."""
    library = subprocess.run([gcc, "-print-file-name=libasan.so"], capture_output=True, text=True, check=True).stdout
    sanitised = {"LD_PRELOAD": library.strip(), "ASAN_OPTIONS": "detect_leaks=0:exitcode=99"}
    build(gcc, folder, ["-fsanitize=address"], overflowing)
    number = (folder / "own.c").read_text("utf-8").splitlines().index("    own[8] = in->t;") + 1
    status, _, err = run(folder, *OWN, **sanitised)
    assert status == 99
    assert "ERROR: AddressSanitizer: heap-buffer-overflow" in err
    first = re.search(r"^ +#0 .*$", err, re.MULTILINE)
    assert first is not None
    assert re.search(rf" in Model_Outputs .*own\.c:{number}$", first[0])
    build(gcc, folder, ["-fsanitize=address"])
    status, out, err = run(folder, *OWN, **sanitised)
    assert "AddressSanitizer" not in err
    assert status in (0, 1, 3)
    assert "ride_through" in out


@pytest.mark.compiler
def test_gdb_stops_in_a_library(gcc, folder):
    """At a breakpoint by its name, with the source and its variables; then the run goes on to its end."""
    gdb = shutil.which("gdb")
    if gdb is None:
        pytest.skip("gdb is missing, so nothing stops in a library")
    build(gcc, folder, [])
    orders = (
        "set breakpoint pending on",
        "break Model_Outputs",
        "run",
        "print info.ModelName",
        "next",
        "delete",
        "continue",
    )
    before = [gdb, "-nx", "-batch", *(word for order in orders for word in ("-ex", order)), "--args"]
    status, out, err = run(folder, *OWN, before=before)
    assert re.search(r"Breakpoint 1.*Model_Outputs \(instance=0x[0-9a-f]+\) at own\.c:\d+", out)
    assert re.search(r'^\$1 = .*"commanding"$', out, re.MULTILINE)
    assert "ride_through" in out
    assert "No such file" not in out + err, "what it has loaded is there to be read"
    assert status == 0


@pytest.mark.compiler
def test_a_crash_says_where_it_was(gcc, folder):
    """The process of the command ends by it; the next run finds what it left, and removes it."""
    build(gcc, folder, [], lambda text: overflowing(text).replace("own[8] = in->t;", "*(volatile int *)0 = 1;"))
    temporary = folder / "temporary"
    temporary.mkdir()
    status, _, err = run(folder, *OWN, TMPDIR=str(temporary))
    assert status < 0
    assert "Fatal Python error: Segmentation fault" in err
    assert [*temporary.glob("pvlvrt-job-*")]
    run(folder, "--controller", "counting.py:Counting", TMPDIR=str(temporary))
    assert not [*temporary.glob("pvlvrt-job-*")]
