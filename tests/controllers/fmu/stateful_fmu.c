/* The bundled controller in C as an FMU by FMI 2 or FMI 3 (-DFMI=2, -DFMI=3) that gives its state, and holds its host
 * to the rules: what is called out of turn fails, or ends the process where nothing can be answered.
 *
 * FORGETS: its state lacks the integral of the DC voltage's control. REFUSES: it does not serialise. CRASHES: it ends
 * with the first state. Value references 0 to 15 are inputs, 100 to 105 outputs, 200 the parameter from whose time on
 * (s) each step ends with a warning.
 */
#include <stdbool.h>
#include <stdlib.h>

#include "controller.c"

enum { OK, WARNING, DISCARD, FAILED };
enum { OWN_INPUTS = sizeof(Inputs) / sizeof(double), ENABLED = OWN_INPUTS, MODULATING, INPUT_COUNT = MODULATING + 3 };
enum { OUTPUT = 100, OUTPUT_COUNT = sizeof(Outputs) / sizeof(double), PARAMETER = 200 };
typedef enum { INSTANTIATED, INITIALISING, STEPPING, TERMINATED, BROKEN } Mode;
typedef void (*log_t)(int status, const char *message);

#define VALUE(name, unit, value, ...) .name = value,
static const Parameters settings = {PARAMETERS(VALUE, VALUE)};

/* All that it remembers; no padding, so that its bytes are its state. */
typedef struct {
    double t; /* where the next step begins (s) */
    double warns_at;
    double inputs[INPUT_COUNT], outputs[OUTPUT_COUNT];
    ControllerState x;
    int32_t counts[2];
} Memory;

typedef struct {
    Memory memory;
    Mode mode;
    int states; /* that have been given and not freed */
} Model;

typedef struct {
    uint64_t sum;
    Memory memory;
} Serialised;

static log_t say;

static int broken(Model *m, const char *why)
{
    m->mode = BROKEN;
    say(FAILED, why);
    return FAILED;
}

static int turned(Model *m, Mode from, Mode to)
{
    if (m->mode != from)
        return broken(m, "called out of turn");
    m->mode = to;
    return OK;
}

static Model *instance(void)
{
    Model *m = calloc(1, sizeof *m);
    m->memory.warns_at = 1e9;
    return m;
}

static void free_instance(Model *m)
{
    if (m->mode != BROKEN && (m->states != 0 || m->mode != TERMINATED))
        abort();
    free(m);
}

static int terminate(Model *m)
{
    if (m->mode != STEPPING) /* an answer is not looked at */
        abort();
    m->mode = TERMINATED;
    return OK;
}

static double *number(Model *m, unsigned vr)
{
    if (vr == PARAMETER)
        return &m->memory.warns_at;
    return vr < OUTPUT ? &m->memory.inputs[vr] : &m->memory.outputs[vr - OUTPUT];
}

static int set(Model *m, const unsigned vr[], size_t n, const double x[])
{
    for (size_t k = 0; k < n; k++)
        *number(m, vr[k]) = x[k];
    return OK;
}

static int get(Model *m, const unsigned vr[], size_t n, double x[])
{
    for (size_t k = 0; k < n; k++)
        x[k] = *number(m, vr[k]);
    return OK;
}

static int step(Model *m, double t, double h)
{
    Memory *own = &m->memory;
    if (m->mode != STEPPING || fabs(t - own->t) > 1e-9)
        return broken(m, "this is not the next step");
    if (t == 0)
        say(OK, "the first step");
    own->t = t + h;
    IEEE_Cigre_DLLInterface_Instance it = {
        .ExternalInputs = own->inputs,
        .ExternalOutputs = own->outputs,
        .Parameters = (void *)&settings,
        .IntStates = own->counts,
        .DoubleStates = (double *)&own->x,
    };
    if (own->inputs[ENABLED] < 0.5) {
        memcpy(own->outputs, own->inputs + MODULATING, 3 * sizeof(double));
        Model_Initialize(&it);
    }
    Model_Outputs(&it);
    return t < own->warns_at ? OK : WARNING;
}

static uint64_t sum_of(const Memory *memory)
{
    uint64_t sum = 14695981039346656037u; /* FNV-1a */
    for (size_t k = 0; k < sizeof *memory; k++)
        sum = (sum ^ ((const unsigned char *)memory)[k]) * 1099511628211u;
    return sum;
}

static int get_state(Model *m, void **state)
{
    if (m->mode != STEPPING)
        return broken(m, "no state can be had now");
#ifdef CRASHES
    abort();
#endif
    Memory *copy = malloc(sizeof *copy);
    *copy = m->memory;
#ifdef FORGETS
    copy->x.dc_voltage.integral = 0;
#endif
    *state = copy;
    m->states++;
    return OK;
}

static int set_state(Model *m, const void *state)
{
    if (m->mode != STEPPING || m->memory.t != 0)
        return broken(m, "no state can be put back now");
    m->memory = *(const Memory *)state;
    return OK;
}

static int free_state(Model *m, void **state)
{
    free(*state);
    *state = NULL;
    m->states--;
    return OK;
}

static int state_size(size_t *size)
{
    *size = sizeof(Serialised);
    return OK;
}

static int serialise(Model *m, const void *state, unsigned char bytes[], size_t size)
{
#ifdef REFUSES
    (void)state, (void)bytes, (void)size;
    return broken(m, "not in this edition");
#else
    Serialised all = {.memory = *(const Memory *)state};
    all.sum = sum_of(&all.memory);
    if (size != sizeof all)
        return broken(m, "not so many bytes");
    memcpy(bytes, &all, size);
    return OK;
#endif
}

static int deserialise(Model *m, const unsigned char bytes[], size_t size, void **state)
{
    Serialised all;
    if (size != sizeof all)
        return broken(m, "the state has another size");
    memcpy(&all, bytes, size);
    if (all.sum != sum_of(&all.memory))
        return broken(m, "the state is damaged");
    Memory *copy = malloc(sizeof *copy);
    *copy = all.memory;
    *state = copy;
    m->states++;
    return OK;
}

#define DO_NOTHING(name) \
    int name(void) { return OK; }

#if FMI == 2
typedef void (*logger_t)(void *, const char *, int, const char *, const char *, ...);
static logger_t logger;
static void say_2(int status, const char *message) { logger(NULL, "small", status, "events", "%s", message); }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const logger_t *callbacks)
{
    (void)name, (void)type, (void)guid, (void)resources;
    logger = callbacks[0];
    say = say_2;
    return instance();
}
void fmi2FreeInstance(void *m) { free_instance(m); }
int fmi2EnterInitializationMode(void *m) { return turned(m, INSTANTIATED, INITIALISING); }
int fmi2ExitInitializationMode(void *m) { return turned(m, INITIALISING, STEPPING); }
int fmi2Terminate(void *m) { return terminate(m); }
int fmi2SetReal(void *m, const unsigned vr[], size_t n, const double x[]) { return set(m, vr, n, x); }
int fmi2GetReal(void *m, const unsigned vr[], size_t n, double x[]) { return get(m, vr, n, x); }
int fmi2DoStep(void *m, double t, double h, int sure) { return sure ? step(m, t, h) : broken(m, "it may go back"); }
int fmi2GetFMUstate(void *m, void **state) { return get_state(m, state); }
int fmi2SetFMUstate(void *m, void *state) { return set_state(m, state); }
int fmi2FreeFMUstate(void *m, void **state) { return free_state(m, state); }
int fmi2SerializedFMUstateSize(void *m, void *state, size_t *n) { return (void)m, (void)state, state_size(n); }
int fmi2SerializeFMUstate(void *m, void *state, unsigned char x[], size_t n) { return serialise(m, state, x, n); }
int fmi2DeSerializeFMUstate(void *m, const unsigned char x[], size_t n, void **s) { return deserialise(m, x, n, s); }
const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return "default"; }
#else
typedef void (*logger_t)(void *, int, const char *, const char *);
static logger_t logger;
static void say_3(int status, const char *message) { logger(NULL, status, "events", message); }

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logs,
                                  bool events, bool early, const unsigned *required, size_t n, void *environment,
                                  logger_t log)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logs, (void)events, (void)early;
    (void)required, (void)n, (void)environment;
    logger = log;
    say = say_3;
    return instance();
}
void fmi3FreeInstance(void *m) { free_instance(m); }
int fmi3EnterInitializationMode(void *m) { return turned(m, INSTANTIATED, INITIALISING); }
int fmi3ExitInitializationMode(void *m) { return turned(m, INITIALISING, STEPPING); }
int fmi3Terminate(void *m) { return terminate(m); }
int fmi3SetFloat64(void *m, const unsigned vr[], size_t n, const double x[], size_t count)
{
    return count == n ? set(m, vr, n, x) : FAILED;
}
int fmi3GetFloat64(void *m, const unsigned vr[], size_t n, double x[], size_t count)
{
    return count == n ? get(m, vr, n, x) : FAILED;
}
int fmi3DoStep(void *m, double t, double h, bool sure, bool *event, bool *ends, bool *early, double *last)
{
    *event = *ends = *early = false;
    *last = t + h;
    return sure ? step(m, t, h) : broken(m, "it may go back");
}
int fmi3GetFMUState(void *m, void **state) { return get_state(m, state); }
int fmi3SetFMUState(void *m, void *state) { return set_state(m, state); }
int fmi3FreeFMUState(void *m, void **state) { return free_state(m, state); }
int fmi3SerializedFMUStateSize(void *m, void *state, size_t *n) { return (void)m, (void)state, state_size(n); }
int fmi3SerializeFMUState(void *m, void *state, unsigned char x[], size_t n) { return serialise(m, state, x, n); }
int fmi3DeserializeFMUState(void *m, const unsigned char x[], size_t n, void **s) { return deserialise(m, x, n, s); }
const char *fmi3GetVersion(void) { return "3.0"; }
#endif
#include "rest_of_fmi.h"
