/* Interface between a controller's real code and a simulation tool, as laid out by CIGRE Technical Brochure 958.
 *
 * A controller is a shared library that exports the functions at the end of this file. The tool allocates an Instance,
 * fills its inputs and parameters, and calls; the controller keeps everything that it must remember in the state arrays
 * of the Instance, never in pointers of its own, since the tool may move these arrays between two calls.
 *
 * Inputs, outputs and parameters are one C structure each, with the ports or parameters as members in the order in
 * which they are announced; a port of Width n is an array member of n numbers. So the controller declares
 *
 *     typedef struct { real64_T u_a_v; real64_T u_b_v; int32_T mode; } Inputs;
 *
 * and reads ((const Inputs *)instance->ExternalInputs)->u_a_v.
 *
 * C99 or C++; sizes and offsets are those of natural alignment on 64 bits.
 */
#ifndef IEEE_CIGRE_DLLINTERFACE_H
#define IEEE_CIGRE_DLLINTERFACE_H

#include <stdint.h>

typedef char char_T;
typedef int8_t int8_T;
typedef uint8_t uint8_T;
typedef int16_t int16_T;
typedef uint16_t uint16_T;
typedef int32_t int32_T;
typedef uint32_t uint32_T;
typedef float real32_T;
typedef double real64_T;

enum IEEE_Cigre_DLLInterface_DataType {
    IEEE_Cigre_DLLInterface_DataType_char_T = 1,
    IEEE_Cigre_DLLInterface_DataType_int8_T,
    IEEE_Cigre_DLLInterface_DataType_uint8_T,
    IEEE_Cigre_DLLInterface_DataType_int16_T,
    IEEE_Cigre_DLLInterface_DataType_uint16_T,
    IEEE_Cigre_DLLInterface_DataType_int32_T,
    IEEE_Cigre_DLLInterface_DataType_uint32_T,
    IEEE_Cigre_DLLInterface_DataType_real32_T,
    IEEE_Cigre_DLLInterface_DataType_real64_T,
    IEEE_Cigre_DLLInterface_DataType_c_string_T /* char *; of parameters only */
};

enum IEEE_Cigre_DLLInterface_ReturnValue {
    IEEE_Cigre_DLLInterface_Return_OK = 0,
    IEEE_Cigre_DLLInterface_Return_Message = 1, /* LastGeneralMessage has something to say; the run goes on */
    IEEE_Cigre_DLLInterface_Return_Error = 2    /* LastErrorMessage says why; the run ends */
};

enum IEEE_Cigre_DLLInterface_Mode { /* what a tool simulates; a model that can do both announces 3 */
    IEEE_Cigre_DLLInterface_Mode_EMT = 1,
    IEEE_Cigre_DLLInterface_Mode_RMS = 2
};

/* An input or output. */
typedef struct IEEE_Cigre_DLLInterface_Signal {
    const char_T *Name; /* a C identifier */
    const char_T *Description;
    const char_T *Unit;
    int32_T DataType; /* enum IEEE_Cigre_DLLInterface_DataType */
    int32_T Width;    /* length of the array, 1 of a single number */
} IEEE_Cigre_DLLInterface_Signal;

typedef union IEEE_Cigre_DLLInterface_Value {
    char_T Char_Val;
    const char_T *Char_Ptr; /* of a default value only */
    int8_T Int8_Val;
    uint8_T Uint8_Val;
    int16_T Int16_Val;
    uint16_T Uint16_Val;
    int32_T Int32_Val;
    uint32_T Uint32_Val;
    real32_T Real32_Val;
    real64_T Real64_Val;
} IEEE_Cigre_DLLInterface_Value;

typedef struct IEEE_Cigre_DLLInterface_Parameter {
    const char_T *Name; /* a C identifier */
    const char_T *GroupName;
    const char_T *Description;
    const char_T *Unit;
    int32_T DataType;
    int32_T FixedValue; /* 1: does not change after the first sample */
    IEEE_Cigre_DLLInterface_Value DefaultValue;
    IEEE_Cigre_DLLInterface_Value MinValue;
    IEEE_Cigre_DLLInterface_Value MaxValue;
} IEEE_Cigre_DLLInterface_Parameter;

/* What a controller says of itself; belongs to it and does not change. */
typedef struct IEEE_Cigre_DLLInterface_Model_Info {
    uint8_T DLLInterfaceVersion[4];
    const char_T *ModelName;
    const char_T *ModelVersion;
    const char_T *ModelDescription;
    const char_T *GeneralInformation;
    const char_T *ModelCreated;
    const char_T *ModelCreator;
    const char_T *ModelLastModifiedDate;
    const char_T *ModelLastModifiedBy;
    const char_T *ModelModifiedComment;
    const char_T *ModelModifiedHistory;
    real64_T FixedStepBaseSampleTime; /* from one call of Model_Outputs to the next (s); -1: the tool's step */
    uint8_T EMT_RMS_Mode;             /* 1 EMT, 2 RMS, 3 both */
    int32_T NumInputPorts;
    const IEEE_Cigre_DLLInterface_Signal *InputPortsInfo;
    int32_T NumOutputPorts;
    const IEEE_Cigre_DLLInterface_Signal *OutputPortsInfo;
    int32_T NumParameters;
    const IEEE_Cigre_DLLInterface_Parameter *ParametersInfo;
    int32_T NumIntStates;
    int32_T NumFloatStates;
    int32_T NumDoubleStates;
} IEEE_Cigre_DLLInterface_Model_Info;

/* One controller at work; belongs to the tool. */
typedef struct IEEE_Cigre_DLLInterface_Instance {
    void *ExternalInputs;
    void *ExternalOutputs;
    void *Parameters;
    real64_T Time; /* simulated time of this call (s) */
    uint8_T SimTool_EMT_RMS_Mode;
    const char_T *LastErrorMessage;   /* the controller's, as long as it lives */
    const char_T *LastGeneralMessage;
    int32_T *IntStates;
    real32_T *FloatStates;
    real64_T *DoubleStates;
} IEEE_Cigre_DLLInterface_Instance;

#ifdef _WIN32
#define IEEE_CIGRE_EXPORT __declspec(dllexport)
#else
#define IEEE_CIGRE_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What this controller is. */
IEEE_CIGRE_EXPORT const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void);

/* Print it; a tool need not call this, and this one never does. */
IEEE_CIGRE_EXPORT int32_T Model_PrintInfo(void);

/* Optional. First call of all, and again after the states of a snapshot have been put back (Time is above 0 then). */
IEEE_CIGRE_EXPORT int32_T Model_FirstCall(IEEE_Cigre_DLLInterface_Instance *instance);

/* Look at the parameters, and change those that cannot be used; the tool has checked their ranges before. */
IEEE_CIGRE_EXPORT int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance);

/* Set the states so that the outputs, which the tool has put where they shall start, follow from the inputs. Called
 * before Model_Outputs in every sample in which the controller does not act yet. */
IEEE_CIGRE_EXPORT int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance);

/* Advance by one sample: from inputs and states to outputs and states. */
IEEE_CIGRE_EXPORT int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance);

/* Optional; of RMS tools. */
IEEE_CIGRE_EXPORT int32_T Model_Iterate(IEEE_Cigre_DLLInterface_Instance *instance);

/* The end of this instance. */
IEEE_CIGRE_EXPORT int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance);

#ifdef __cplusplus
}
#endif

#endif
