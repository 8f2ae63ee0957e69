/* A controller that goes on with what modulates, and at a time of its choice does something that none should do.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "ieee_cigre.h"

enum { NOTHING, CRASH, ENDLESS_LOOP, NOT_A_NUMBER, TOO_LARGE, ERROR_, PRINT, EXIT, MESSAGE, UNDEFINED_ANSWER, ABORT };

typedef struct {
    real64_T u_a_v, u_b_v, u_c_v, m_a, m_b, m_c;
} Inputs;
typedef struct {
    real64_T m_a, m_b, m_c, calls;
} Outputs;
typedef struct {
    int32_T how;
    real64_T at_s;
    real64_T below_v; /* only when the voltage is below it */
} Parameters;

#define REAL(name, unit) {name, "", unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 1}

static const IEEE_Cigre_DLLInterface_Signal inputs[] = {
    REAL("u_a_v", "V"), REAL("u_b_v", "V"), REAL("u_c_v", "V"), REAL("m_a", ""), REAL("m_b", ""), REAL("m_c", ""),
};
static const IEEE_Cigre_DLLInterface_Signal outputs[] = {
    REAL("m_a", ""), REAL("m_b", ""), REAL("m_c", ""), REAL("calls", ""),
};
static const IEEE_Cigre_DLLInterface_Parameter parameters[] = {
    {"how", "", "", "", IEEE_Cigre_DLLInterface_DataType_int32_T, 1, {.Int32_Val = 0}, {.Int32_Val = 0}, {.Int32_Val = 10}},
    {"at_s", "", "", "s", IEEE_Cigre_DLLInterface_DataType_real64_T, 1, {.Real64_Val = 0.0}, {.Real64_Val = 0.0}, {.Real64_Val = 100.0}},
    {"below_v", "", "", "V", IEEE_Cigre_DLLInterface_DataType_real64_T, 1, {.Real64_Val = 1e6}, {.Real64_Val = 0.0}, {.Real64_Val = 1e6}},
};
static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .DLLInterfaceVersion = {1, 1, 0, 0},
    .ModelName = "misbehaving",
    .FixedStepBaseSampleTime = -1,
#ifdef RMS_ONLY
    .EMT_RMS_Mode = 2,
#else
    .EMT_RMS_Mode = 3,
#endif
    .NumInputPorts = 6,
    .InputPortsInfo = inputs,
    .NumOutputPorts = 4,
    .OutputPortsInfo = outputs,
    .NumParameters = 3,
    .ParametersInfo = parameters,
};

static int calls; /* shared by all instances in one copy of the library */

static int32_T misbehave(IEEE_Cigre_DLLInterface_Instance *instance, Outputs *out, int how)
{
    volatile int forever = 1;
    switch (how) {
    case CRASH:
        *(volatile int *)0 = 1;
        break;
    case ENDLESS_LOOP:
        while (forever)
            ;
        break;
    case NOT_A_NUMBER:
        out->m_b = NAN;
        break;
    case TOO_LARGE:
        out->m_c = 1e3;
        break;
    case ERROR_:
        instance->LastErrorMessage = "the current measurement is implausible";
        return IEEE_Cigre_DLLInterface_Return_Error;
    case PRINT:
        printf("{\"not\": \"our json\"}\n");
        fflush(stdout);
        break;
    case EXIT:
        exit(0);
    case MESSAGE:
        instance->LastGeneralMessage = "the limiter is active";
        return IEEE_Cigre_DLLInterface_Return_Message;
    case UNDEFINED_ANSWER:
        return 7;
    case ABORT:
        abort();
    }
    return IEEE_Cigre_DLLInterface_Return_OK;
}

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }

int32_T Model_PrintInfo(void)
{
    printf("nobody asked for this\n");
    return 0;
}

int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance)
{
    Parameters *p = instance->Parameters;
    if (p->at_s == 66.0) {
        p->at_s = 99.0;
        instance->LastGeneralMessage = "at_s was not to my liking";
    }
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance;
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Inputs *in = instance->ExternalInputs;
    const Parameters *p = instance->Parameters;
    Outputs *out = instance->ExternalOutputs;
    double squares = in->u_a_v * in->u_a_v + in->u_b_v * in->u_b_v + in->u_c_v * in->u_c_v;
    /* What modulates now, a sample on; at this angle the current hardly changes. */
    double c = cos(2 * 3.141592653589793 * 50 * 40.9568e-6), s = sin(2 * 3.141592653589793 * 50 * 40.9568e-6);
    out->m_a = c * in->m_a + s * (in->m_c - in->m_b) / sqrt(3);
    out->m_b = c * in->m_b + s * (in->m_a - in->m_c) / sqrt(3);
    out->m_c = c * in->m_c + s * (in->m_b - in->m_a) / sqrt(3);
    out->calls = ++calls;
    if (instance->Time < p->at_s || sqrt(squares / 3) >= p->below_v)
        return IEEE_Cigre_DLLInterface_Return_OK;
    return misbehave(instance, out, p->how);
}

int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance;
    return IEEE_Cigre_DLLInterface_Return_OK;
}
