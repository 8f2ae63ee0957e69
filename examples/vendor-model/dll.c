/* LCL1000 by the IEEE/CIGRE DLL interface: its ports, its parameters, and its state in the arrays of the instance. */
#include "ieee_cigre.h"
#include "law.h"

#include <string.h>

#define COUNT(array) (int32_T)(sizeof(array) / sizeof((array)[0]))
#define NUMBER(name, unit, words) {#name, words, unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 1}
#define SWITCH(name, words) {#name, words, "", IEEE_Cigre_DLLInterface_DataType_int32_T, 1}

static const IEEE_Cigre_DLLInterface_Signal inputs_info[] = {
    NUMBER(VCa, "kV", "filter capacitor, phase to neutral"),
    NUMBER(VCb, "kV", "filter capacitor, phase to neutral"),
    NUMBER(VCc, "kV", "filter capacitor, phase to neutral"),
    NUMBER(VGa, "kV", "grid terminals, phase to neutral"),
    NUMBER(VGb, "kV", "grid terminals, phase to neutral"),
    NUMBER(VGc, "kV", "grid terminals, phase to neutral"),
    NUMBER(I1a, "kA", "inverter side of the filter, out of the bridge"),
    NUMBER(I1b, "kA", "inverter side of the filter, out of the bridge"),
    NUMBER(I1c, "kA", "inverter side of the filter, out of the bridge"),
    NUMBER(I2a, "kA", "grid side of the filter, into the grid"),
    NUMBER(I2b, "kA", "grid side of the filter, into the grid"),
    NUMBER(I2c, "kA", "grid side of the filter, into the grid"),
    NUMBER(Vdc, "kV", "DC link"),
    NUMBER(Vdc_MPP, "kV", "DC link where the array gives its most"),
    NUMBER(P_avail, "MW", "most that the array can give now"),
    NUMBER(P_request, "pu", "active power that is asked for, of Sbase"),
    NUMBER(Q_request, "pu", "reactive power that is asked for, of Sbase, positive: into the grid"),
    SWITCH(Run, "1: the bridge follows the commands"),
    SWITCH(CB_closed, "1: connected to the grid"),
};

static const IEEE_Cigre_DLLInterface_Signal outputs_info[] = {
    NUMBER(Ea, "kV", "bridge voltage, to the middle of the link"),
    NUMBER(Eb, "kV", "bridge voltage, to the middle of the link"),
    NUMBER(Ec, "kV", "bridge voltage, to the middle of the link"),
    SWITCH(TRIP, "1: open the breaker, for good"),
    SWITCH(BLOCK, "1: turn no device on"),
    NUMBER(Vpos, "pu", "positive sequence of the grid voltage"),
    NUMBER(Vmin, "pu", "lowest phase of the grid voltage"),
    NUMBER(Freq, "Hz", "frequency of the grid voltage"),
    NUMBER(P_meas, "MW", "into the grid"),
    NUMBER(Q_meas, "Mvar", "into the grid"),
    NUMBER(P_ref, "MW", "asked of the current control"),
    NUMBER(Q_ref, "Mvar", "asked of the current control"),
};

#define PARAMETER(group, name, unit, words, value, least, most)                                                     \
    {#name, group, words, unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 0, {.Real64_Val = value},                \
     {.Real64_Val = least}, {.Real64_Val = most}}
#define OPTION(group, name, words, value)                                                                           \
    {#name, group, words, "", IEEE_Cigre_DLLInterface_DataType_int32_T, 0, {.Int32_Val = value}, {.Int32_Val = 0},  \
     {.Int32_Val = 1}}

static const IEEE_Cigre_DLLInterface_Parameter parameters_info[] = {
    PARAMETER("bases", VLLbase, "V", "rated voltage, line to line, rms", 600, 100, 1e5),
    PARAMETER("bases", Sbase, "kVA", "rated power", 1000, 1, 1e6),
    PARAMETER("bases", fbase, "Hz", "rated frequency", 50, 40, 70),
    PARAMETER("control", Imax, "pu", "most current", 1.1, 0.1, 2),
    PARAMETER("control", R1, "pu", "inverter side of the filter", 0.003, 0, 1),
    PARAMETER("control", X1, "pu", "inverter side of the filter", 0.15, 0.01, 1),
    PARAMETER("control", Kp, "pu", "of the current control", 1.2, 0, 10),
    PARAMETER("control", Ki, "pu/s", "of either resonator", 190, 0, 1e4),
    PARAMETER("control", Kdc, "pu/pu", "power by the DC voltage", 6.5, 0, 100),
    PARAMETER("control", Ksync, "", "of the sequence filter", 1.414, 0.1, 4),
    PARAMETER("control", Tfreq, "s", "filter of the frequency", 0.05, 0.001, 10),
    PARAMETER("fault", Kfrt, "pu/pu", "reactive current by voltage", 3.5, 0, 10),
    PARAMETER("fault", Vlow, "pu", "support below it", 0.9, 0, 1),
    PARAMETER("fault", Vhigh, "pu", "support above it", 1.1, 1, 2),
    PARAMETER("fault", P_ramp, "pu/s", "active power comes back", 5, 0.01, 1000),
    PARAMETER("protection", UV1_level, "pu", "lowest phase, first step", 0.85, 0, 1),
    PARAMETER("protection", UV1_delay, "s", "first step", 1.6, 0, 3600),
    PARAMETER("protection", UV2_level, "pu", "lowest phase, second step", 0.45, 0, 1),
    PARAMETER("protection", UV2_delay, "s", "second step", 1.0, 0, 3600),
    OPTION("protection", MC_enable, "1: momentary cessation", 0),
    PARAMETER("protection", MC_level, "pu", "lowest phase: cessation below it", 0.5, 0, 1),
    PARAMETER("protection", MC_release, "s", "the bridge works again so much later", 0.02, 0, 10),
};

static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .DLLInterfaceVersion = {1, 1, 0, 0},
    .ModelName = "LCL1000",
    .ModelVersion = "2.3",
    .ModelDescription = "PV inverter with an LCL filter, 1 MVA at 600 V",
    .GeneralInformation = "",
    .ModelCreated = "",
    .ModelCreator = "",
    .ModelLastModifiedDate = "",
    .ModelLastModifiedBy = "",
    .ModelModifiedComment = "",
    .ModelModifiedHistory = "",
    .FixedStepBaseSampleTime = SAMPLE_TIME,
    .EMT_RMS_Mode = IEEE_Cigre_DLLInterface_Mode_EMT,
    .NumInputPorts = COUNT(inputs_info),
    .InputPortsInfo = inputs_info,
    .NumOutputPorts = COUNT(outputs_info),
    .OutputPortsInfo = outputs_info,
    .NumParameters = COUNT(parameters_info),
    .ParametersInfo = parameters_info,
    .NumIntStates = sizeof(Counts) / sizeof(int32_T),
    .NumDoubleStates = sizeof(Numbers) / sizeof(real64_T),
};

/* The tool may move its arrays between two calls: they are read at the begin of each, and written at its end. */
static State load(const IEEE_Cigre_DLLInterface_Instance *instance)
{
    State s;
    memcpy(&s.x, instance->DoubleStates, sizeof s.x);
    memcpy(&s.n, instance->IntStates, sizeof s.n);
    return s;
}

static void save(IEEE_Cigre_DLLInterface_Instance *instance, const State *s)
{
    memcpy(instance->DoubleStates, &s->x, sizeof s->x);
    memcpy(instance->IntStates, &s->n, sizeof s->n);
}

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }

int32_T Model_PrintInfo(void) { return IEEE_Cigre_DLLInterface_Return_OK; }

int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Parameters *p = instance->Parameters;
    if (p->Vlow >= p->Vhigh) {
        instance->LastErrorMessage = "Vlow must be below Vhigh";
        return IEEE_Cigre_DLLInterface_Return_Error;
    }
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance)
{
    State s;
    law_begin(&s, instance->ExternalInputs, instance->Parameters);
    save(instance, &s);
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    State s = load(instance);
    law_step(&s, instance->ExternalOutputs, instance->ExternalInputs, instance->Parameters);
    save(instance, &s);
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance;
    return IEEE_Cigre_DLLInterface_Return_OK;
}
