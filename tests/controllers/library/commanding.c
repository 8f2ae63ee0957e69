/* A controller that gives what modulates again, turned on with a grid of 50 Hz by one sample, in each of the ways in which a voltage can be commanded, and blocks.
 *
 * DUTY: duties of the legs, in %; FRAME: voltages in a frame, in kV and degrees; else modulating signals. With
 * `enable_until` it takes its enable back at that instant (s).
 */
#include "ieee_cigre.h"

#include <math.h>

#define THIRD 2.0943951023931953
#define TYPE(name) IEEE_Cigre_DLLInterface_DataType_##name##_T

typedef struct { real64_T t, m[3], v_dc; } In;
typedef struct { real64_T of[3]; int32_T pwm_enable, initialised; real64_T began_at; } Out;

static const IEEE_Cigre_DLLInterface_Signal inputs[] = {
    {"time", "", "s", TYPE(real64), 1},
    {"m", "", "", TYPE(real64), 3},
    {"Vdc", "", "V", TYPE(real64), 1},
};
static const IEEE_Cigre_DLLInterface_Signal outputs[] = {
#if defined FRAME
    {"Vd_ref", "", "kV", TYPE(real64), 1},
    {"Vq_ref", "", "kV", TYPE(real64), 1},
    {"theta_ref", "", "deg", TYPE(real64), 1},
#elif defined DUTY
    {"m", "", "duty", TYPE(real64), 3},
#else
    {"m", "", "", TYPE(real64), 3},
#endif
    {"pwm_enable", "", "", TYPE(int32), 1},
    {"initialised", "how often", "", TYPE(int32), 1},
    {"began_at", "largest of the first three outputs at the first Initialize", "", TYPE(real64), 1},
};
static const IEEE_Cigre_DLLInterface_Parameter parameters[] = {
    {"enable_until", "", "", "s", TYPE(real64), 0, {.Real64_Val = 1e9}, {.Real64_Val = 0}, {.Real64_Val = 1e9}},
};
static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .ModelName = "commanding",
    .FixedStepBaseSampleTime = 1e-4,
    .EMT_RMS_Mode = 1,
    .NumInputPorts = 3,
    .InputPortsInfo = inputs,
    .NumOutputPorts = sizeof outputs / sizeof *outputs,
    .OutputPortsInfo = outputs,
    .NumParameters = 1,
    .ParametersInfo = parameters,
};

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }
int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }
static int32_T initialised;
static double began_at;

int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Out *out = instance->ExternalOutputs;
    if (!initialised++)
        began_at = fmax(fmax(fabs(out->of[0]), fabs(out->of[1])), fabs(out->of[2]));
    return 0;
}

int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const In *in = instance->ExternalInputs;
    Out *out = instance->ExternalOutputs;
    const double step = 0.03141592653589793, a = in->m[0], b = (in->m[1] - in->m[2]) / sqrt(3);
    const double alpha = cos(step) * a - sin(step) * b, beta = sin(step) * a + cos(step) * b;
    double m[3];
    for (int k = 0; k < 3; k++)
        m[k] = alpha * cos(k * THIRD) + beta * sin(k * THIRD);
#if defined FRAME
    const double angle = 0.7, kv = 0.5e-3 * in->v_dc; /* any frame is as good as another */
    out->of[0] = out->of[1] = 0;
    for (int k = 0; k < 3; k++) {
        out->of[0] += 2.0 / 3 * kv * m[k] * cos(angle - k * THIRD);
        out->of[1] -= 2.0 / 3 * kv * m[k] * sin(angle - k * THIRD);
    }
    out->of[2] = angle * 180 / 3.141592653589793;
#else
    for (int k = 0; k < 3; k++)
#if defined DUTY
        out->of[k] = 0.5 * (1 + m[k]);
#else
        out->of[k] = m[k];
#endif
#endif
    out->initialised = initialised;
    out->began_at = began_at;
    out->pwm_enable = in->t < *(const double *)instance->Parameters;
    return 0;
}
