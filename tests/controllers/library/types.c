/* Every type of number, wide ports and texts: what goes in comes out, with the parameters added. */
#include <string.h>

#include "ieee_cigre.h"

#define NUMBERS(N) N(char) N(real64) N(int8) N(uint8) N(int16) N(real32) N(uint16) N(int32) N(uint32)

#define MEMBER(type) type##_T of_##type;
#define WIDE_MEMBER(type) type##_T wide_##type[3];
typedef struct { NUMBERS(MEMBER) NUMBERS(WIDE_MEMBER) } Ports;
typedef struct { NUMBERS(MEMBER) const char_T *text; real64_T after; } Parameters;

#define PORT(type) {"of_" #type, "", "", IEEE_Cigre_DLLInterface_DataType_##type##_T, 1},
#define WIDE_PORT(type) {"wide_" #type, "", "", IEEE_Cigre_DLLInterface_DataType_##type##_T, 3},
static const IEEE_Cigre_DLLInterface_Signal ports[] = {NUMBERS(PORT) NUMBERS(WIDE_PORT)};

#define LIMITED(type, field) \
    {"of_" #type, "", "", "", IEEE_Cigre_DLLInterface_DataType_##type##_T, 0, {.field = 1}, {.field = 0}, {.field = 100}},
static const IEEE_Cigre_DLLInterface_Parameter parameters[] = {
    LIMITED(char, Char_Val) LIMITED(real64, Real64_Val) LIMITED(int8, Int8_Val) LIMITED(uint8, Uint8_Val)
    LIMITED(int16, Int16_Val) LIMITED(real32, Real32_Val) LIMITED(uint16, Uint16_Val) LIMITED(int32, Int32_Val)
    LIMITED(uint32, Uint32_Val)
    {"text", "", "", "", IEEE_Cigre_DLLInterface_DataType_c_string_T, 0, {.Char_Ptr = "a default"}, {0}, {0}},
    {"after", "", "", "", IEEE_Cigre_DLLInterface_DataType_real64_T, 0, {.Real64_Val = 0.5}, {0}, {0}},
};
static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .ModelName = "types",
    .FixedStepBaseSampleTime = 1e-4,
    .EMT_RMS_Mode = 1,
    .NumInputPorts = 18,
    .InputPortsInfo = ports,
    .NumOutputPorts = 18,
    .OutputPortsInfo = ports,
    .NumParameters = 11,
    .ParametersInfo = parameters,
    .NumFloatStates = 1,
};

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }
int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }
int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }
int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance) { return (void)instance, 0; }

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Ports *in = instance->ExternalInputs;
    const Parameters *p = instance->Parameters;
    Ports *out = instance->ExternalOutputs;
#define ADD(type) out->of_##type = in->of_##type + p->of_##type;
#define ADD_WIDE(type) for (int k = 0; k < 3; k++) out->wide_##type[k] = in->wide_##type[k] + p->of_##type;
    NUMBERS(ADD)
    NUMBERS(ADD_WIDE)
    out->of_real64 += (double)strlen(p->text) + p->after;
    instance->FloatStates[0] += 1;
    return 0;
}
