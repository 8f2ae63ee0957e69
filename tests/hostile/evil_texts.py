"""Texts of controllers that do harm once, in the first deep sag; a deed may also give what the controller answers."""

PYTHON = '''
import array, atexit, builtins, ctypes, decimal, fractions, math, os, signal, sys, threading, time
import numpy as np

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
            given = deed(self)
            if given is not None:
                return given
        return [(u + 0.1 * (self.g * u - i)) / (0.5 * y.v_dc_v) for u, i in zip(y[1:4], y[4:7])]
'''

PYTHON_DEEDS = {
    "answers with no number": ("return (math.nan, 0.0, 0.0)", "nan"),
    "answers without end": ("return (math.inf, 0.0, 0.0)", "inf"),
    "answers with words": ("return ('a', 'b', 'c')", "'a'"),
    "answers with too much": ("return [0.0] * 10_000_000", ""),
    "answers with a long number": ("return (10**5000, 0, 0)", ""),
    "answers with another kind": ("return {1: 2}", ""),
    "answers with a generator": ("return (math.sqrt(x) for x in (1, 4, -1))", ""),
    "ends Python": ("raise SystemExit('no')", "no"),
    "interrupts": ("raise KeyboardInterrupt", ""),
    "raises what says nothing": (
        "class Silent(BaseException):\n    def __str__(self): raise Silent\n    __repr__ = __str__\nraise Silent",
        "",
    ),
    "recurses": ("return deed(self)", "RecursionError"),
    "changes what is built in": ("builtins.len = builtins.float = builtins.isinstance = None", ""),
    "commands the runner": ("raise ValueError('\\n::error::forged\\x1b[31m\\n##[error]forged')", "forged"),
}
"""What is done and the words of the error; no words where more than one end is right."""

PROGRAM = """
import ctypes, json, os, resource, signal, sys, threading, time

{deed}


def say(**said):
    sys.stdout.write(json.dumps(said) + "\\n")
    sys.stdout.flush()


def write(text):
    sys.stdout.buffer.write(text if isinstance(text, bytes) else text.encode())
    sys.stdout.flush()
    return {}


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
        given = None
        if u < deep and not is_done:
            is_done = True
            given = deed()
        if given is None:
            pairs = [(x, told[f"u_{x}_v"], told[f"i_{x}_a"]) for x in "abc"]
            given = {f"m_{x}": (u + 0.1 * (g * u - i)) / (0.5 * told["v_dc_v"]) for x, u, i in pairs}
        if given:
            say(**given)
"""

PROGRAM_DEEDS = {
    name: (
        deed if "\n" in deed or deed.startswith(("return", "raise", "os.", "sys.")) else f"return write({deed})",
        words,
    )
    for name, (deed, words) in {
        "answers with no number": ("return {'m_a': float('nan'), 'm_b': 0, 'm_c': 0}", "nan"),
        "answers without end": ("return {'m_a': float('inf'), 'm_b': 0, 'm_c': 0}", "inf"),
        "answers with words": ("return {'m_a': 'a', 'm_b': 'b', 'm_c': 'c'}", "m_a"),
        "answers with a long number": ("'{\"m_a\": ' + '9' * 5000 + ', \"m_b\": 0, \"m_c\": 0}\\n'", "m_a"),
        "answers with an exponent": ('\'{"m_a": 1e999, "m_b": 0, "m_c": 0}\\n\'', "m_a"),
        "answers with a part": ("return {'m_a': 0.5}", "m_b"),
        "answers with true": ("return {'m_a': True, 'm_b': 0, 'm_c': 0}", ""),
        "answers with a list": ("'[1, 2, 3]\\n'", "object"),
        "answers with nothing": ("'\\n'", ""),
        "answers deep": ("'[' * 100000 + '\\n'", ""),
        "answers twice the same": ('\'{"m_a": 0, "m_a": 1, "m_b": 0, "m_c": 0}\\n\'', ""),
        "answers in no text": ("b'\\xff\\xfe\\x00\\n'", ""),
        "answers with zero bytes": ("b'\\x00' * 5000 + b'\\n'", ""),
        "commands the runner": ("'::error::forged\\x1b[31m\\n'", ""),
        "answers with more": ("return {'m_a': 0.1, 'm_b': 0, 'm_c': 0, 'x' * 90000: 'y'}", ""),
        "closes its mouth": ("sys.stdout.flush()\nos.close(1)\nwhile True: time.sleep(1)", ""),
        "closes its ears": ("os.close(0)\nreturn write('{}\\n')", ""),
        "ends by a signal": ("os.kill(os.getpid(), signal.SIGTERM)\ntime.sleep(60)", "signal 15"),
        "becomes another": ("os.execvp('true', ['true'])", ""),
        "limits itself": ("resource.setrlimit(resource.RLIMIT_NOFILE, (0, 0))\nreturn None", ""),
        "raises": ("raise ValueError('\\x1b[31m' + 'x' * 100_000)", ""),
        "kills its group": ("os.killpg(0, signal.SIGKILL)", ""),
    }.items()
}
"""The same of a program, which speaks in lines."""

_C = r"""
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static void *wait_forever(void *x) { for (;;) pause(); return x; }
static int deeper(int n) { volatile char room[4096]; room[0] = n; return deeper(n + 1) + room[0]; }
static int deed(double m[3])
{
    {deed}
}
/* Of three voltages, three currents and that of the link: the voltage ahead, and a regulator of the current. */
static int once(const double u[7], double m[3])
{
    static int done;
    const double g = 0.8 * 500e3 / (3 * 230.0 * 230.0);
    for (int k = 0; k < 3; k++)
        m[k] = (u[k] + 0.1 * (g * u[k] - u[3 + k])) / (0.5 * u[6]);
    if (done || sqrt(2.0 / 3.0 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])) >= {below} * sqrt(2.0) * 230.0)
        return 0;
    done = 1;
    return deed(m);
}
"""

LIBRARY = (
    _C
    + r"""
#include "ieee_cigre.h"

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

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }
int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance) { return 0; }
int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance) { return 0; }
int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance) { return 0; }
int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    return once(instance->ExternalInputs, instance->ExternalOutputs);
}
"""
)

FMU = (
    _C
    + r"""
static double numbers[10];

#define DO_NOTHING(name) int name(void) { return 0; }
DO_NOTHING(fmi2SetupExperiment) DO_NOTHING(fmi2EnterInitializationMode) DO_NOTHING(fmi2ExitInitializationMode)
DO_NOTHING(fmi2Terminate) DO_NOTHING(fmi2Reset) DO_NOTHING(fmi2SetDebugLogging) DO_NOTHING(fmi2SetInteger)
DO_NOTHING(fmi2SetBoolean) DO_NOTHING(fmi2SetString) DO_NOTHING(fmi2GetInteger) DO_NOTHING(fmi2GetBoolean)
DO_NOTHING(fmi2GetString) DO_NOTHING(fmi2GetFMUstate) DO_NOTHING(fmi2SetFMUstate) DO_NOTHING(fmi2FreeFMUstate)
DO_NOTHING(fmi2SerializedFMUstateSize) DO_NOTHING(fmi2SerializeFMUstate) DO_NOTHING(fmi2DeSerializeFMUstate)
DO_NOTHING(fmi2GetDirectionalDerivative) DO_NOTHING(fmi2SetRealInputDerivatives)
DO_NOTHING(fmi2GetRealOutputDerivatives) DO_NOTHING(fmi2CancelStep) DO_NOTHING(fmi2GetStatus)
DO_NOTHING(fmi2GetRealStatus) DO_NOTHING(fmi2GetIntegerStatus) DO_NOTHING(fmi2GetBooleanStatus)
DO_NOTHING(fmi2GetStringStatus)
const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
void *fmi2Instantiate(const char *a, int b, const char *c, const char *d, const void *e, int f, int g)
{
    return numbers;
}
void fmi2FreeInstance(void *c) {}
int fmi2SetReal(void *c, const unsigned vr[], size_t n, const double x[])
{
    for (size_t k = 0; k < n; k++) numbers[vr[k]] = x[k];
    return 0;
}
int fmi2GetReal(void *c, const unsigned vr[], size_t n, double x[])
{
    for (size_t k = 0; k < n; k++) x[k] = numbers[vr[k]];
    return 0;
}
int fmi2DoStep(void *c, double t, double h, int last)
{
    return once(numbers, numbers + 7);
}
"""
)


def _variable(number: int, name: str, causality: str) -> str:
    start = ' start="0"' if causality == "input" else ""
    head = f'<ScalarVariable name="{name}" valueReference="{number}" causality="{causality}">'
    return f"{head}<Real{start}/></ScalarVariable>"


_INPUTS = ("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "v_dc_v")
_OUTPUTS = ("m_a", "m_b", "m_c")

DESCRIPTION = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<fmiModelDescription fmiVersion="2.0" modelName="evil" guid="{1}"><CoSimulation modelIdentifier="evil"/>'
    '<DefaultExperiment stepSize="1e-4"/><ModelVariables>'
    + "".join(_variable(k, name, "input") for k, name in enumerate(_INPUTS))
    + "".join(_variable(7 + k, name, "output") for k, name in enumerate(_OUTPUTS))
    + "</ModelVariables><ModelStructure><Outputs>"
    + "".join(f'<Unknown index="{8 + k}"/>' for k in range(len(_OUTPUTS)))
    + "</Outputs></ModelStructure></fmiModelDescription>"
)
"""Of the FMU, whose binary is of version 2."""

C_DEEDS = {
    "answers with no number": ("m[0] = NAN; return 0;", "nan"),
    "answers without end": ("m[0] = INFINITY; return 0;", "inf"),
    "answers far out": ("m[0] = -1e308; return 0;", ""),
    "says that it failed": ("return 3;", ""),
    "says what is no status": ("return 12345;", ""),
    "aborts": ("abort(); return 0;", "SIGABRT"),
    "divides by zero": ("raise(SIGFPE); return 0;", "SIGFPE"),
    "overflows its stack": ("return deeper(0);", "SIGSEGV"),
    "jumps to nowhere": ("((void (*)(void))16)(); return 0;", "SIGSEGV"),
    "ends politely": ("exit(3); return 0;", "status 3"),
    "kills its group": ("kill(0, SIGKILL); pause(); return 0;", ""),
    "closes all files": ("for (int k = 3; k < 4096; k++) close(k); return 0;", ""),
    "closes its streams": ("close(0); close(1); close(2); return 0;", ""),
    "goes elsewhere": ('if (chdir("/")) abort(); return 0;', ""),
    "forgets its surroundings": ("clearenv(); return 0;", ""),
    "hears no signal": (
        "sigset_t all; sigfillset(&all); sigprocmask(SIG_BLOCK, &all, 0); for (volatile int x = 1; x;) ; return 0;",
        "simulation.time_limit_s",
    ),
    "sleeps": ("for (;;) sleep(600); return 0;", "simulation.time_limit_s"),
    "has itself woken": ("alarm(1); for (;;) pause(); return 0;", ""),
    "limits itself": (
        "struct rlimit no = {0, 0}; setrlimit(RLIMIT_NOFILE, &no); setrlimit(RLIMIT_FSIZE, &no); return 0;", "",
    ),
    "becomes another": ('execl("/bin/true", "true", (char *)0); return 0;', ""),
    "spoils its stack": ("volatile char *here = (char *)m - 256; memset((char *)here, 65, 4096); return 0;", ""),
    "spoils its memory": ("char *x = malloc(16); memset(x - 64, 65, 4096); free(x); free(malloc(9999)); return 0;", ""),
    "asks for addresses": (
        "mmap(0, 1ul << 40, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0); return 0;", "",
    ),
    "starts threads": (
        "pthread_t t; for (int k = 0; k < 5000; k++) pthread_create(&t, 0, wait_forever, 0); return 0;", "",
    ),
    "quits": ("raise(SIGQUIT); return 0;", "SIGQUIT"),
    "writes to nobody": (
        "int two[2]; pipe(two); close(two[0]); signal(SIGPIPE, SIG_DFL); write(two[1], two, 4); return 0;", "",
    ),
    "ends as a pipe does": ("signal(SIGPIPE, SIG_DFL); raise(SIGPIPE); return 0;", "SIGPIPE"),
    "commands the runner": ('puts("::error::forged\\n\\x1b[31m##[error]forged"); abort(); return 0;', "SIGABRT"),
}  # fmt: skip
"""The same in C, of a library and of an FMU; the last statement gives the status of the step."""
