/* An FMU for co-simulation by FMI 2 or FMI 3 (-DFMI=2, -DFMI=3): m_a, m_b, m_c are what modulates, times a gain.
 *
 * From the time of a parameter on, its step ends by the status of another. Own declarations: of FMI's headers only
 * names and types of the functions are repeated, and those that are not needed do nothing.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { OK, WARNING, DISCARD, ERROR, FATAL, PENDING, TERMINATE };
enum { INPUTS = 3, OUTPUT = 3, GAIN = 6, FAIL_AT = 7, COUNT = 8, STATUS = 100, SOFTLY = 101 };

static double numbers[COUNT] = {[GAIN] = 1, [FAIL_AT] = 1e9};
static int status, softly;

static int step(double t)
{
    for (int k = 0; k < INPUTS; k++)
        numbers[OUTPUT + k] = numbers[GAIN] * numbers[k];
    return t < numbers[FAIL_AT] ? OK : status;
}

#define DO_NOTHING(name) \
    int name(void) { return OK; }

#if FMI == 2
typedef void (*logger_t)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    logger_t logger;
} callbacks_t;

static const callbacks_t *callbacks;

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const callbacks_t *functions)
{
    (void)name, (void)type, (void)guid, (void)resources;
    callbacks = functions;
    return numbers;
}
void fmi2FreeInstance(void *c) { (void)c; }
int fmi2SetReal(void *c, const unsigned vr[], size_t n, const double x[])
{
    (void)c;
    for (size_t k = 0; k < n; k++)
        numbers[vr[k]] = x[k];
    return OK;
}
int fmi2GetReal(void *c, const unsigned vr[], size_t n, double x[])
{
    (void)c;
    for (size_t k = 0; k < n; k++)
        x[k] = numbers[vr[k]];
    return OK;
}
int fmi2SetInteger(void *c, const unsigned vr[], size_t n, const int x[])
{
    (void)c, (void)vr;
    status = x[n - 1];
    return OK;
}
int fmi2SetBoolean(void *c, const unsigned vr[], size_t n, const int x[])
{
    (void)c, (void)vr;
    softly = x[n - 1];
    return OK;
}
int fmi2DoStep(void *c, double t, double h, int finished)
{
    (void)c, (void)h, (void)finished;
    int found = step(t);
    if (found != OK && !softly)
        callbacks->logger(NULL, "small", found, "events", "limit %d reached by %s", 42, "the link");
    return found == TERMINATE ? DISCARD : found;
}
int fmi2GetBooleanStatus(void *c, int kind, int *value)
{
    (void)c;
    *value = kind == 3 && status == TERMINATE;
    return OK;
}
const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return "default"; }
DO_NOTHING(fmi2SetDebugLogging)
DO_NOTHING(fmi2SetupExperiment)
DO_NOTHING(fmi2EnterInitializationMode)
DO_NOTHING(fmi2ExitInitializationMode)
DO_NOTHING(fmi2Terminate)
DO_NOTHING(fmi2Reset)
DO_NOTHING(fmi2GetInteger)
DO_NOTHING(fmi2GetBoolean)
DO_NOTHING(fmi2GetString)
DO_NOTHING(fmi2SetString)
DO_NOTHING(fmi2GetFMUstate)
DO_NOTHING(fmi2SetFMUstate)
DO_NOTHING(fmi2FreeFMUstate)
DO_NOTHING(fmi2SerializedFMUstateSize)
DO_NOTHING(fmi2SerializeFMUstate)
DO_NOTHING(fmi2DeSerializeFMUstate)
DO_NOTHING(fmi2GetDirectionalDerivative)
DO_NOTHING(fmi2SetRealInputDerivatives)
DO_NOTHING(fmi2GetRealOutputDerivatives)
DO_NOTHING(fmi2CancelStep)
DO_NOTHING(fmi2GetStatus)
DO_NOTHING(fmi2GetRealStatus)
DO_NOTHING(fmi2GetIntegerStatus)
DO_NOTHING(fmi2GetStringStatus)
#else
typedef void (*logger_t)(void *, int, const char *, const char *);

static logger_t log_message;

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logs,
                                  bool events, bool early, const unsigned *required, size_t n, void *environment,
                                  logger_t logger)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logs, (void)events, (void)early;
    (void)required, (void)n, (void)environment;
    log_message = logger;
    return numbers;
}
void fmi3FreeInstance(void *c) { (void)c; }
/* Value references 0 and 3 are arrays of three, GAIN and FAIL_AT are scalars. */
static size_t width(unsigned vr) { return vr < GAIN ? 3 : 1; }
int fmi3SetFloat64(void *c, const unsigned vr[], size_t n, const double x[], size_t count)
{
    (void)c, (void)count;
    for (size_t k = 0; k < n; x += width(vr[k++]))
        memcpy(numbers + vr[k], x, width(vr[k]) * sizeof *x);
    return OK;
}
int fmi3GetFloat64(void *c, const unsigned vr[], size_t n, double x[], size_t count)
{
    (void)c, (void)count;
    for (size_t k = 0; k < n; x += width(vr[k++]))
        memcpy(x, numbers + vr[k], width(vr[k]) * sizeof *x);
    return OK;
}
int fmi3SetInt32(void *c, const unsigned vr[], size_t n, const int x[], size_t count)
{
    (void)c, (void)vr, (void)count;
    status = x[n - 1];
    return OK;
}
int fmi3SetBoolean(void *c, const unsigned vr[], size_t n, const bool x[], size_t count)
{
    (void)c, (void)vr, (void)count;
    softly = x[n - 1];
    return OK;
}
int fmi3DoStep(void *c, double t, double h, bool finished, bool *event, bool *terminate, bool *early, double *last)
{
    (void)c, (void)finished;
    int found = step(t);
    *event = *early = false;
    *terminate = found == TERMINATE;
    *last = t + h;
    if (found != OK && !softly)
        log_message(NULL, found, "events", "limit 42 reached by the link");
    return found == TERMINATE ? OK : found;
}
const char *fmi3GetVersion(void) { return "3.0"; }
#include "rest_of_fmi.h"
#endif
