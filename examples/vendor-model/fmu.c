/* LCL1000 as an FMU (FMI 2.0, co-simulation). modelDescription.xml gives each variable the number that it has here.
 *
 * Of FMI's headers only names and types of the functions are repeated; what a tool need not call does nothing.
 */
#include "law.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT
#endif

#define GUID "{6c1d5f0a-lcl1000-2.3}"
enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { INPUT = 0, OUTPUT = 100, PARAMETER = 200 }; /* first numbers of each */

typedef struct {
    State state;
    Inputs in;
    Outputs out;
    Parameters p;
} Model;

/* What modelDescription.xml has as start values. */
static const Parameters defaults = {
    .VLLbase = 600, .Sbase = 1000, .fbase = 50, .Imax = 1.1, .R1 = 0.003, .X1 = 0.15, .Kp = 1.2, .Ki = 190, .Kdc = 6.5,
    .Ksync = 1.414, .Tfreq = 0.05, .Kfrt = 3.5, .Vlow = 0.9, .Vhigh = 1.1, .P_ramp = 5, .UV1_level = 0.85,
    .UV1_delay = 1.6, .UV2_level = 0.45, .UV2_delay = 1, .MC_enable = 0, .MC_level = 0.5, .MC_release = 0.02,
};

/* Where a variable lies, and whether it is a whole number. */
typedef struct {
    size_t offset;
    int is_whole;
} Place;

#define IN(name) {offsetof(Model, in.name), 0}
#define IN_WHOLE(name) {offsetof(Model, in.name), 1}
#define OUT(name) {offsetof(Model, out.name), 0}
#define OUT_WHOLE(name) {offsetof(Model, out.name), 1}
#define SET(name) {offsetof(Model, p.name), 0}
#define SET_WHOLE(name) {offsetof(Model, p.name), 1}

static const Place inputs[] = {
    IN(VCa), IN(VCb), IN(VCc), IN(VGa), IN(VGb), IN(VGc), IN(I1a), IN(I1b), IN(I1c), IN(I2a), IN(I2b), IN(I2c),
    IN(Vdc), IN(Vdc_MPP), IN(P_avail), IN(P_request), IN(Q_request), IN_WHOLE(Run), IN_WHOLE(CB_closed),
};
static const Place outputs[] = {
    OUT(Ea), OUT(Eb), OUT(Ec), OUT_WHOLE(TRIP), OUT_WHOLE(BLOCK), OUT(Vpos), OUT(Vmin), OUT(Freq),
    OUT(P_meas), OUT(Q_meas), OUT(P_ref), OUT(Q_ref),
};
static const Place parameters[] = {
    SET(VLLbase), SET(Sbase), SET(fbase), SET(Imax), SET(R1), SET(X1), SET(Kp), SET(Ki), SET(Kdc), SET(Ksync),
    SET(Tfreq), SET(Kfrt), SET(Vlow), SET(Vhigh), SET(P_ramp), SET(UV1_level), SET(UV1_delay), SET(UV2_level),
    SET(UV2_delay), SET_WHOLE(MC_enable), SET(MC_level), SET(MC_release),
};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const Place *place_of(unsigned number)
{
    if (number >= PARAMETER)
        return number - PARAMETER < COUNT(parameters) ? &parameters[number - PARAMETER] : NULL;
    if (number >= OUTPUT)
        return number - OUTPUT < COUNT(outputs) ? &outputs[number - OUTPUT] : NULL;
    return number < COUNT(inputs) ? &inputs[number] : NULL;
}

/* The variable of a number, if it is of this type; else NULL. */
static void *variable(void *model, unsigned number, int is_whole)
{
    const Place *place = place_of(number);
    return place != NULL && place->is_whole == is_whole ? (char *)model + place->offset : NULL;
}

EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }

EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *callbacks,
                             int visible, int logs)
{
    (void)name, (void)type, (void)resources, (void)callbacks, (void)visible, (void)logs;
    Model *model = strcmp(guid, GUID) == 0 ? calloc(1, sizeof(Model)) : NULL;
    if (model != NULL)
        model->p = defaults;
    return model;
}
EXPORT void fmi2FreeInstance(void *model) { free(model); }

EXPORT int fmi2SetReal(void *model, const unsigned numbers[], size_t n, const double x[])
{
    for (size_t k = 0; k < n; k++) {
        double *own = variable(model, numbers[k], 0);
        if (own == NULL)
            return ERROR;
        *own = x[k];
    }
    return OK;
}
EXPORT int fmi2GetReal(void *model, const unsigned numbers[], size_t n, double x[])
{
    for (size_t k = 0; k < n; k++) {
        const double *own = variable(model, numbers[k], 0);
        if (own == NULL)
            return ERROR;
        x[k] = *own;
    }
    return OK;
}
EXPORT int fmi2SetInteger(void *model, const unsigned numbers[], size_t n, const int x[])
{
    for (size_t k = 0; k < n; k++) {
        int32_t *own = variable(model, numbers[k], 1);
        if (own == NULL)
            return ERROR;
        *own = x[k];
    }
    return OK;
}
EXPORT int fmi2GetInteger(void *model, const unsigned numbers[], size_t n, int x[])
{
    for (size_t k = 0; k < n; k++) {
        const int32_t *own = variable(model, numbers[k], 1);
        if (own == NULL)
            return ERROR;
        x[k] = *own;
    }
    return OK;
}

EXPORT int fmi2DoStep(void *model, double t, double step, int is_final)
{
    (void)t, (void)step, (void)is_final;
    Model *m = model;
    if (!m->state.n.started)
        law_begin(&m->state, &m->in, &m->p);
    law_step(&m->state, &m->out, &m->in, &m->p);
    return OK;
}

#define DO_NOTHING(name) \
    EXPORT int name(void) { return OK; }
#define REFUSE(name) \
    EXPORT int name(void) { return ERROR; }
DO_NOTHING(fmi2SetDebugLogging)
DO_NOTHING(fmi2SetupExperiment)
DO_NOTHING(fmi2EnterInitializationMode)
DO_NOTHING(fmi2ExitInitializationMode)
DO_NOTHING(fmi2Terminate)
REFUSE(fmi2Reset)
REFUSE(fmi2SetBoolean)
REFUSE(fmi2GetBoolean)
REFUSE(fmi2SetString)
REFUSE(fmi2GetString)
REFUSE(fmi2GetFMUstate)
REFUSE(fmi2SetFMUstate)
REFUSE(fmi2FreeFMUstate)
REFUSE(fmi2SerializedFMUstateSize)
REFUSE(fmi2SerializeFMUstate)
REFUSE(fmi2DeSerializeFMUstate)
REFUSE(fmi2GetDirectionalDerivative)
REFUSE(fmi2SetRealInputDerivatives)
REFUSE(fmi2GetRealOutputDerivatives)
REFUSE(fmi2CancelStep)
REFUSE(fmi2GetStatus)
REFUSE(fmi2GetRealStatus)
REFUSE(fmi2GetIntegerStatus)
REFUSE(fmi2GetBooleanStatus)
REFUSE(fmi2GetStringStatus)
