/* The filter of low_pass.py by the IEEE/CIGRE DLL interface, with ports as makers have them: one of three, in kV. */
#include "ieee_cigre.h"

typedef struct {
    real64_T V_abc[3];
} Inputs;

typedef struct {
    real64_T ma, mb, mc;
    int32_T samples;
} Outputs;

static const IEEE_Cigre_DLLInterface_Signal inputs[] = {
    {"V_abc", "Voltages of the grid, phase to neutral", "kV", IEEE_Cigre_DLLInterface_DataType_real64_T, 3},
};
static const IEEE_Cigre_DLLInterface_Signal outputs[] = {
    {"ma", "Modulating signal of phase a", "-", IEEE_Cigre_DLLInterface_DataType_real64_T, 1},
    {"mb", "Modulating signal of phase b", "-", IEEE_Cigre_DLLInterface_DataType_real64_T, 1},
    {"mc", "Modulating signal of phase c", "-", IEEE_Cigre_DLLInterface_DataType_real64_T, 1},
    {"samples", "Samples since the start", "-", IEEE_Cigre_DLLInterface_DataType_int32_T, 1},
};
static const IEEE_Cigre_DLLInterface_Parameter parameters[] = {
    {"gain", "", "Gain", "-", IEEE_Cigre_DLLInterface_DataType_real64_T, 1, {.Real64_Val = 1}, {.Real64_Val = 0},
     {.Real64_Val = 10}},
};
static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .DLLInterfaceVersion = {1, 1, 0, 0},
    .ModelName = "Low pass",
    .ModelVersion = "1.0.0.0",
    .FixedStepBaseSampleTime = 100e-6,
    .EMT_RMS_Mode = 1,
    .NumInputPorts = 1,
    .InputPortsInfo = inputs,
    .NumOutputPorts = 4,
    .OutputPortsInfo = outputs,
    .NumParameters = 1,
    .ParametersInfo = parameters,
    .NumIntStates = 1,
    .NumDoubleStates = 6,
};

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }
int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *it) { return (void)it, 0; }
int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *it) { return (void)it, 0; }

int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *it)
{
    for (int k = 0; k < 6; k++)
        it->DoubleStates[k] = 0;
    it->IntStates[0] = 0;
    return 0;
}

static real64_T filtered(real64_T x, real64_T *state)
{
    const real64_T b0 = 0.020083365564211232, b1 = 0.040166731128422464, b2 = 0.020083365564211232;
    const real64_T a1 = -1.5610180758007182, a2 = 0.6413515380575631;
    real64_T out = b0 * x + state[0];
    state[0] = b1 * x - a1 * out + state[1];
    state[1] = b2 * x - a2 * out;
    return out;
}

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *it)
{
    const Inputs *in = it->ExternalInputs;
    Outputs *out = it->ExternalOutputs;
    real64_T gain = *(const real64_T *)it->Parameters;
    real64_T *m[] = {&out->ma, &out->mb, &out->mc};
    for (int k = 0; k < 3; k++)
        *m[k] = filtered(gain * in->V_abc[k] / 0.4, it->DoubleStates + 2 * k);
    out->samples = ++it->IntStates[0];
    return 0;
}
