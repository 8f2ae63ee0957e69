"""Texts of controllers that do harm once, in the first deep sag: three doors, and what is done."""

PYTHON = '''
import ctypes, json, os, signal, shutil, subprocess, sys, tempfile, threading, time
from pathlib import Path

{deed}


class Controller:
    """Voltage ahead, and a proportional regulator of the current."""

    sample_time_s = 1e-4

    def reset(self, nominal):
        self.deep, self.is_done = {below} * 2**0.5 * nominal.phase_voltage_v, False
        self.g = 0.8 * nominal.apparent_power_va / (3 * nominal.phase_voltage_v**2)

    def step(self, y):
        u = (2 / 3 * (y.u_a_v**2 + y.u_b_v**2 + y.u_c_v**2)) ** 0.5
        if u < self.deep and not self.is_done:
            self.is_done = True
            deed()
        return [(u + 0.1 * (self.g * u - i)) / (0.5 * y.v_dc_v) for u, i in zip(y[1:4], y[4:7])]
'''

PROGRAM = """
import ctypes, json, os, signal, shutil, subprocess, sys, tempfile, threading, time
from pathlib import Path

{deed}


def say(**said):
    sys.stdout.write(json.dumps(said) + "\\n")
    sys.stdout.flush()


is_done, deep = False, 0.0
for line in sys.stdin:
    told = json.loads(line)
    if "protocol" in told:
        say(version=1, sample_time_s=1e-4)
    elif "start" in told:
        nominal = told["start"]["nominal"]
        deep = {below} * 2**0.5 * nominal["phase_voltage_v"]
        g = 0.8 * nominal["apparent_power_va"] / (3 * nominal["phase_voltage_v"] ** 2)
        say(ready=True)
    elif "end" in told:
        break
    else:
        u = (2 / 3 * (told["u_a_v"] ** 2 + told["u_b_v"] ** 2 + told["u_c_v"] ** 2)) ** 0.5
        if u < deep and not is_done:
            is_done = True
            deed()
        pairs = [(x, told[f"u_{x}_v"], told[f"i_{x}_a"]) for x in "abc"]
        say(**{f"m_{x}": (u + 0.1 * (g * u - i)) / (0.5 * told["v_dc_v"]) for x, u, i in pairs})
"""

LIBRARY = r"""
#define _GNU_SOURCE
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ieee_cigre.h"

typedef struct { real64_T u_a_v, u_b_v, u_c_v, i_a_a, i_b_a, i_c_a, v_dc_v; } Inputs;
typedef struct { real64_T m_a, m_b, m_c; } Outputs;

#define REAL(name, unit) {name, "", unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 1}
static const IEEE_Cigre_DLLInterface_Signal inputs[] = {
    REAL("u_a_v", "V"), REAL("u_b_v", "V"), REAL("u_c_v", "V"), REAL("i_a_a", "A"), REAL("i_b_a", "A"),
    REAL("i_c_a", "A"), REAL("v_dc_v", "V"),
};
static const IEEE_Cigre_DLLInterface_Signal outputs[] = {REAL("m_a", ""), REAL("m_b", ""), REAL("m_c", "")};
static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .DLLInterfaceVersion = {1, 1, 0, 0}, .ModelName = "evil", .FixedStepBaseSampleTime = 1e-4, .EMT_RMS_Mode = 3,
    .NumInputPorts = 7, .InputPortsInfo = inputs, .NumOutputPorts = 3, .OutputPortsInfo = outputs,
};

static void deed(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance;
    %(deed)s
}

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }
int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance) { (void)instance; return 0; }
int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance) { (void)instance; return 0; }
int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance) { (void)instance; return 0; }
int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    static int done;
    const Inputs *in = instance->ExternalInputs;
    Outputs *out = instance->ExternalOutputs;
    double u = sqrt(2.0 / 3.0 * (in->u_a_v * in->u_a_v + in->u_b_v * in->u_b_v + in->u_c_v * in->u_c_v));
    if (u < %(below)s * sqrt(2.0) * 230.0 && !done) {
        done = 1;
        deed(instance);
    }
    const double g = 0.8 * 500e3 / (3 * 230.0 * 230.0), half = 0.5 * in->v_dc_v;
    out->m_a = (in->u_a_v + 0.1 * (g * in->u_a_v - in->i_a_a)) / half;
    out->m_b = (in->u_b_v + 0.1 * (g * in->u_b_v - in->i_b_a)) / half;
    out->m_c = (in->u_c_v + 0.1 * (g * in->u_c_v - in->i_c_a)) / half;
    return 0;
}
"""

PYTHON_DEEDS = {
    "exits": "os._exit(0)",
    "dies": "os.kill(os.getpid(), signal.SIGKILL)",
    "loops": "[signal.signal(n, signal.SIG_IGN) for n in (signal.SIGTERM, signal.SIGINT)]\nwhile True: pass",
    "stops itself": "os.kill(os.getpid(), signal.SIGSTOP)",
    "stops its parent": "os.kill(os.getppid(), signal.SIGSTOP)\nwhile True: time.sleep(1)",
    "kills its parent": "os.kill(os.getppid(), signal.SIGKILL)\ntime.sleep(60)",
    "eats memory": "a = []\nwhile True: a.append(bytearray(b'x') * (16 << 20))",
    "eats memory in a child": (
        "subprocess.run([sys.executable, '-c', 'a = []\\nwhile True: a.append(bytearray(b\"x\") * (16 << 20))'])\n"
        "time.sleep(60)"
    ),
    "prints without end": "while True: sys.stderr.write('x' * 9999 + '\\n')",
    "prints 100 MB": "for _ in range(1000): sys.stderr.write('x' * 99999 + '\\n')\nsys.stderr.flush()",
    "starts processes": (
        "a = [subprocess.Popen(['sleep', '600'], start_new_session=True) for _ in range(300)]\ntime.sleep(60)"
    ),
    "leaves processes": "subprocess.Popen(['sh', '-c', 'setsid sleep 600 & setsid sleep 600 &'])\nos._exit(4)",
    "writes a big file": (
        "with Path(tempfile.gettempdir(), 'big').open('wb') as f:\n    while True: f.write(b'x' * (1 << 20))"
    ),
    "writes many files": (
        "k = 0\nwhile True:\n    k += 1\n"
        "    folder = Path(tempfile.gettempdir(), str(k // 1000)); folder.mkdir(exist_ok=True)\n"
        "    (folder / str(k)).touch()"
    ),
    "removes its folder": "shutil.rmtree(tempfile.gettempdir())",
    "locks its folder": "Path(tempfile.gettempdir()).chmod(0)\nos._exit(3)",
    "long message": "raise ValueError('x' * 100_000_000)",
    "forks and goes on": "os.fork()",
    "forges an answer": (
        "folder = Path(tempfile.gettempdir())\n"
        "(folder / 'answer.json').write_text(json.dumps({'channels': ['u_a_v'], 'notes': [], 'tripped_at_s': None}))\n"
        "(folder / 'record.npy').write_bytes(bytes(8))\n"
        "(folder / 'record.f64').write_bytes(bytes(8))\n"
        "os._exit(0)"
    ),
    "forges with a pickle": (
        "import pickle\n"
        "class Bomb:\n    def __reduce__(self): return Path.touch, (Path(__file__).with_suffix('.hit'),)\n"
        "folder = Path(tempfile.gettempdir())\n"
        "for name in ('answer.json', 'answer.pickle', 'job.pickle', 'record.npy', 'record.f64'):\n"
        "    (folder / name).write_bytes(pickle.dumps(Bomb()))\n"
        "os._exit(0)"
    ),
    "forges no JSON": ("(Path(tempfile.gettempdir()) / 'answer.json').write_bytes(b'\\xff[' * 1000)\nos._exit(0)"),
    "forges a deep answer": ("(Path(tempfile.gettempdir()) / 'answer.json').write_text('[' * 200_000)\nos._exit(0)"),
    "forges a long answer": (
        "with (Path(tempfile.gettempdir()) / 'answer.json').open('wb') as f: f.truncate(1 << 36)\nos._exit(0)"
    ),
    "forges with a pipe": (
        "folder = Path(tempfile.gettempdir())\n"
        "for name in ('answer.json', 'record.f64', 'said.txt', 'progress.bin'):\n"
        "    (folder / name).unlink(missing_ok=True); os.mkfifo(folder / name)\n"
        "os._exit(0)"
    ),
    "forges with a link": (
        "folder = Path(tempfile.gettempdir())\n"
        "for name in ('answer.json', 'record.f64', 'said.txt', 'progress.bin'):\n"
        "    (folder / name).unlink(missing_ok=True); (folder / name).symlink_to('/dev/zero')\n"
        "os._exit(0)"
    ),
    "spoils its progress": (
        "with (Path(tempfile.gettempdir()) / 'progress.bin').open('r+b') as f: f.write(b'\\xff' * 99999)\nos._exit(0)"
    ),
    "speaks to its parent's reader": (
        "for file in Path(f'/proc/{os.getppid()}/fd').iterdir():\n"
        "    try:\n"
        "        if 'pipe' in os.readlink(file):\n"
        "            os.write(os.open(file, os.O_WRONLY | os.O_NONBLOCK), b'ended 0\\n' * 99)\n"
        "    except OSError: pass\n"
        "time.sleep(1)\nos._exit(0)"
    ),
    "answers then dies": "os._exit = lambda status: os.kill(os.getpid(), signal.SIGSEGV)",
    "closes all files": "os.closerange(3, 4096)",
    "says more than one line": "sys.stdout.write('{}\\n{}\\n')\nsys.stdout.flush()",
    "says one endless line": "while True: sys.stdout.write('x' * 65536)",
}
"""What is done, in Python; of a class and of a program alike."""

LIBRARY_DEEDS = {
    "exits": "_exit(0);",
    "crashes": "*(volatile int *)8 = 1;",
    "loops": "for (volatile int forever = 1; forever;) ;",
    "stops itself": "raise(SIGSTOP);",
    "stops its parent": "kill(getppid(), SIGSTOP); pause();",
    "kills its parent": "kill(getppid(), SIGKILL); pause();",
    "eats memory": "for (;;) memset(malloc(16 << 20), 1, 16 << 20);",
    "prints without end": 'for (;;) puts("what nobody wants to read, and that again and again, line by line");',
    "starts processes": "for (int k = 0; k < 300; k++) if (fork() == 0) { setsid(); pause(); }\n    pause();",
    "forks and goes on": "if (fork() < 0) abort();",
    "smashes its heap": "memset(instance->ExternalOutputs, 0x41, 1 << 20);",
    "frees what is not its own": "free((char *)instance->ExternalOutputs + 8);",
    "long message": (
        "char *text = malloc(100000001); memset(text, 'x', 100000000); text[100000000] = 0;\n"
        "    instance->LastErrorMessage = text; ((Outputs *)instance->ExternalOutputs)->m_a = NAN; puts(text);"
    ),
}
"""What is done, in C."""
