/* A controller whose parameters are of every type that the interface has; it gives what it is given. */
#include "ieee_cigre.h"

typedef struct { real64_T m[3]; } Ports;

#define TYPE(name) IEEE_Cigre_DLLInterface_DataType_##name##_T
static const IEEE_Cigre_DLLInterface_Signal inputs[] = {{"m", "", "", TYPE(real64), 3}};
static const IEEE_Cigre_DLLInterface_Signal outputs[] = {{"m", "", "", TYPE(real64), 3}};
static const IEEE_Cigre_DLLInterface_Parameter parameters[] = {
    {"gain", "", "", "", TYPE(real64), 0, {.Real64_Val = 1}, {.Real64_Val = 0}, {.Real64_Val = 2}},
    {"status", "", "", "", TYPE(int32), 0, {.Int32_Val = 0}, {.Int32_Val = 0}, {.Int32_Val = 6}},
    {"word", "", "", "", TYPE(c_string), 0, {.Char_Ptr = "slow"}, {0}, {0}},
    {"tenth", "", "", "", TYPE(real32), 0, {.Real32_Val = 0.5f}, {.Real32_Val = 0.1f}, {.Real32_Val = 0.7f}},
};
static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .ModelName = "parameterised",
    .FixedStepBaseSampleTime = 1e-4,
    .EMT_RMS_Mode = 1,
    .NumInputPorts = 1,
    .InputPortsInfo = inputs,
    .NumOutputPorts = 1,
    .OutputPortsInfo = outputs,
    .NumParameters = 4,
    .ParametersInfo = parameters,
};

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }
int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }
int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }
int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    *(Ports *)instance->ExternalOutputs = *(const Ports *)instance->ExternalInputs;
    return 0;
}
