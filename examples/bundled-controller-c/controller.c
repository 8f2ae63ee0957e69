/* The bundled controller as a shared library by the IEEE/CIGRE DLL interface.
 *
 * The control itself is in blocks.h; this file is what ties it to the interface: ports, parameters, states. All that is
 * remembered from one sample to the next lies in the state arrays of the Instance, so that a snapshot of them can be
 * put back, and any number of instances run side by side.
 */
#include <string.h>

#include "blocks.h"
#include "ieee_cigre.h"

#define SAMPLE_TIME 40.9568e-6

/* Names and units are those that the plant has for its signals, so that no mapping is needed. */
#define INPUTS(PORT)                                                                                                   \
    PORT(u_a_v, "V", "voltage at the PCC, phase to neutral")                                                           \
    PORT(u_b_v, "V", "")                                                                                               \
    PORT(u_c_v, "V", "")                                                                                               \
    PORT(i_a_a, "A", "current into the grid")                                                                          \
    PORT(i_b_a, "A", "")                                                                                               \
    PORT(i_c_a, "A", "")                                                                                               \
    PORT(v_dc_v, "V", "voltage of the DC link")                                                                        \
    PORT(i_pv_a, "A", "current of the PV array")                                                                       \
    PORT(q_set_var, "var", "reactive power in normal operation")                                                       \
    PORT(frequency_nominal_hz, "Hz", "")                                                                               \
    PORT(apparent_power_nominal_va, "VA", "")                                                                          \
    PORT(voltage_nominal_v, "V", "phase to neutral, rms")

#define OUTPUTS(PORT)                                                                                                  \
    PORT(m_a, "", "modulating signal, of half the DC link's voltage")                                                  \
    PORT(m_b, "", "")                                                                                                  \
    PORT(m_c, "", "")                                                                                                  \
    PORT(v_fault_pu, "pu", "positive sequence of the voltage, as the fault detector has it")                           \
    PORT(q_ref_var, "var", "reactive power that is asked for")                                                         \
    PORT(p_ref_w, "W", "active power that is asked for")

#define PARAMETERS(REAL, WHOLE)                                                                                        \
    REAL(sogi_gain, "", 1.4142135623730951, 0.01, 10.0, "K")                                                           \
    REAL(fll_gain, "1/s", 50.0, 0.0, 1e4, "Gamma")                                                                     \
    REAL(fll_frequency_min_hz, "Hz", 40.0, 1.0, 400.0, "guard of the synchronisation")                                 \
    REAL(fll_frequency_max_hz, "Hz", 70.0, 1.0, 400.0, "guard of the synchronisation")                                 \
    REAL(fault_threshold_pu, "pu", 0.85, 0.01, 2.0, "a fault is flagged below it")                                     \
    REAL(reactive_plateau_voltage_pu, "pu", 0.5, 0.0, 2.0, "full reactive power below it")                             \
    REAL(reactive_plateau_pu, "pu", 0.75, 0.0, 1.0, "full reactive power")                                             \
    REAL(sequence_difference_min_pu, "pu", 0.005, 1e-6, 1.0, "below this V+ - V- no current is asked for")             \
    REAL(dc_proportional_gain_w_per_v, "W/V", 3977.5, 0.0, 1e6, "")                                                    \
    REAL(dc_integral_gain_w_per_vs, "W/(V s)", 152110.0, 0.0, 1e8, "")                                                 \
    REAL(pr_proportional_gain, "1/A", 0.0011, 0.0, 1.0, "")                                                            \
    REAL(pr_integral_gain, "1/A", 0.1, 0.0, 100.0, "at resonance")                                                     \
    REAL(pr_cutoff_rad_s, "rad/s", 1.0, 0.001, 1000.0, "of every resonator")                                           \
    REAL(hc5_integral_gain, "1/A", 0.1, 0.0, 100.0, "at resonance")                                                    \
    REAL(hc7_integral_gain, "1/A", 0.1, 0.0, 100.0, "at resonance")                                                    \
    REAL(hc11_integral_gain, "1/A", 0.1, 0.0, 100.0, "at resonance")                                                   \
    REAL(hc13_integral_gain, "1/A", 0.1, 0.0, 100.0, "at resonance")                                                   \
    WHOLE(resonator_lead_samples, "", 2, 0, 20, "delay compensation")                                                  \
    REAL(mppt_period_s, "s", 0.04, 1e-4, 10.0, "between two perturbations")                                            \
    REAL(mppt_step_v, "V", 0.5, 0.0, 50.0, "size of a perturbation")                                                   \
    REAL(mppt_voltage_min_v, "V", 600.0, 0.0, 2000.0, "lower limit of v*_DC")                                          \
    REAL(mppt_voltage_max_v, "V", 1000.0, 1.0, 2000.0, "upper limit of v*_DC")                                         \
    REAL(mppt_start_v, "V", 0.0, 0.0, 2000.0, "where the search begins; 0: at the measured voltage")                   \
    REAL(grid_voltage_feedforward, "", 0.0, 0.0, 1.0, "share of the grid voltage that is fed forward")

#define NUMBER(name, ...) real64_T name;
#define WHOLE_NUMBER(name, ...) int32_T name;
typedef struct { INPUTS(NUMBER) } Inputs;
typedef struct { OUTPUTS(NUMBER) } Outputs;
typedef struct { PARAMETERS(NUMBER, WHOLE_NUMBER) } Parameters;

#define PORT_INFO(name, unit, description)                                                                             \
    {#name, description, unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 1},
#define REAL_INFO(name, unit, value, low, high, description)                                                           \
    {#name, "", description, unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 0,                                       \
     {.Real64_Val = value}, {.Real64_Val = low}, {.Real64_Val = high}},
#define WHOLE_INFO(name, unit, value, low, high, description)                                                          \
    {#name, "", description, unit, IEEE_Cigre_DLLInterface_DataType_int32_T, 0,                                        \
     {.Int32_Val = value}, {.Int32_Val = low}, {.Int32_Val = high}},

static const IEEE_Cigre_DLLInterface_Signal inputs[] = {INPUTS(PORT_INFO)};
static const IEEE_Cigre_DLLInterface_Signal outputs[] = {OUTPUTS(PORT_INFO)};
static const IEEE_Cigre_DLLInterface_Parameter parameters[] = {PARAMETERS(REAL_INFO, WHOLE_INFO)};

#define COUNT(array) (int32_T)(sizeof(array) / sizeof *(array))

static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .DLLInterfaceVersion = {1, 1, 0, 0},
    .ModelName = "bundled controller in C",
    .ModelVersion = "1",
    .ModelDescription = "LVRT control of a single-stage PV inverter",
    .FixedStepBaseSampleTime = SAMPLE_TIME,
    .EMT_RMS_Mode = IEEE_Cigre_DLLInterface_Mode_EMT,
    .NumInputPorts = COUNT(inputs),
    .InputPortsInfo = inputs,
    .NumOutputPorts = COUNT(outputs),
    .OutputPortsInfo = outputs,
    .NumParameters = COUNT(parameters),
    .ParametersInfo = parameters,
    .NumIntStates = 1,
    .NumDoubleStates = sizeof(ControllerState) / sizeof(double),
};

static ControllerState load(const IEEE_Cigre_DLLInterface_Instance *instance)
{
    ControllerState x;
    memcpy(&x, instance->DoubleStates, sizeof x);
    x.mppt.k = instance->IntStates[0];
    return x;
}

static void save(IEEE_Cigre_DLLInterface_Instance *instance, ControllerState x)
{
    instance->IntStates[0] = (int32_T)x.mppt.k;
    x.mppt.k = 0; /* a whole number has no place among the others */
    memcpy(instance->DoubleStates, &x, sizeof x);
}

static Measured measured(const Inputs *in)
{
    return (Measured){
        .u_g_ab = vector_of(in->u_a_v, in->u_b_v, in->u_c_v),
        .i_ab = vector_of(in->i_a_a, in->i_b_a, in->i_c_a),
        .v_dc = in->v_dc_v,
        .i_pv = in->i_pv_a,
    };
}

/* Gains and limits from the parameters, which may change at any time. */
static ControllerParams controller_params(const Parameters *p, const Inputs *in)
{
    double u_nom = sqrt(3) * in->voltage_nominal_v;
    int64_t period = llround(p->mppt_period_s / SAMPLE_TIME);
    return (ControllerParams){
        .sync.fll = {
            .K = p->sogi_gain,
            .gamma = p->fll_gain,
            .w_min = 2 * PI * p->fll_frequency_min_hz,
            .w_max = 2 * PI * p->fll_frequency_max_hz,
            .norm_min = 2 * (0.01 * u_nom) * (0.01 * u_nom),
        },
        .lvrt = {
            .S_nom = in->apparent_power_nominal_va,
            .u_nom = u_nom,
            .V_detect = p->fault_threshold_pu,
            .V_full = p->reactive_plateau_voltage_pu,
            .Q_full = p->reactive_plateau_pu,
            .Q_set = in->q_set_var,
        },
        .dc_voltage = {.K_P = p->dc_proportional_gain_w_per_v, .K_I = p->dc_integral_gain_w_per_vs},
        .mppt = {
            .period = period > 2 ? period : 2,
            .dv = p->mppt_step_v,
            .v_min = p->mppt_voltage_min_v,
            .v_max = p->mppt_voltage_max_v,
        },
        .references.u_pos_less_neg_min = p->sequence_difference_min_pu * u_nom,
        .current = {
            .K_P = p->pr_proportional_gain,
            .K_I = p->pr_integral_gain,
            .K_I5 = p->hc5_integral_gain,
            .K_I7 = p->hc7_integral_gain,
            .K_I11 = p->hc11_integral_gain,
            .K_I13 = p->hc13_integral_gain,
            .w_c = p->pr_cutoff_rad_s,
            .lead = p->resonator_lead_samples,
        },
        .modulator = {.K_PWM = BRIDGE_GAIN, .m_max = M_MAX, .feedforward = p->grid_voltage_feedforward},
        .T = SAMPLE_TIME,
    };
}

static SogiState in_steady_state(vector u) { return (SogiState){.u = u, .qu = -ahead(u)}; }

/* States from which `m` goes on while the inverter feeds what it feeds now. */
static ControllerState steady_state(Measured y, vector m, double w, double v_ref, const ControllerParams *p)
{
    ControllerState x = {
        .sync.msogi = {.h1 = in_steady_state(y.u_g_ab), .w = w},
        .dc_voltage.integral = dot(y.u_g_ab, y.i_ab) - p->dc_voltage.K_P * (y.v_dc - v_ref),
        .mppt = {.v_ref = v_ref, .direction = 1.0, .P_before = -1.0},
    };
    if (p->current.K_I > 0)
        x.current.h1 = in_steady_state(m / p->current.K_I);
    return x;
}

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }

int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Parameters *p = instance->Parameters;
    if (p->fll_frequency_min_hz >= p->fll_frequency_max_hz)
        instance->LastErrorMessage = "fll_frequency_min_hz must be below fll_frequency_max_hz";
    else if (p->reactive_plateau_voltage_pu >= p->fault_threshold_pu)
        instance->LastErrorMessage = "reactive_plateau_voltage_pu must be below fault_threshold_pu";
    else if (p->mppt_voltage_min_v >= p->mppt_voltage_max_v)
        instance->LastErrorMessage = "mppt_voltage_min_v must be below mppt_voltage_max_v";
    else
        return IEEE_Cigre_DLLInterface_Return_OK;
    return IEEE_Cigre_DLLInterface_Return_Error;
}

int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Inputs *in = instance->ExternalInputs;
    const Outputs *out = instance->ExternalOutputs;
    const Parameters *p = instance->Parameters;
    ControllerParams params = controller_params(p, in);
    Measured y = measured(in);
    double wanted = p->mppt_start_v > 0 ? p->mppt_start_v : y.v_dc;
    double v_ref = min(max(wanted, p->mppt_voltage_min_v), p->mppt_voltage_max_v);
    vector m = 0.5 / BRIDGE_GAIN * vector_of(out->m_a, out->m_b, out->m_c);
    save(instance, steady_state(y, m, 2 * PI * in->frequency_nominal_hz, v_ref, &params));
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Inputs *in = instance->ExternalInputs;
    ControllerParams params = controller_params(instance->Parameters, in);
    ControllerState x = load(instance);
    ControllerSignals signals = controller_step(&x, measured(in), &params);
    save(instance, x);
    double m[3];
    phases_of(BRIDGE_GAIN / 0.5 * signals.m, m);
    *(Outputs *)instance->ExternalOutputs = (Outputs){
        .m_a = m[0],
        .m_b = m[1],
        .m_c = m[2],
        .v_fault_pu = signals.V_fault,
        .q_ref_var = signals.Q_ref,
        .p_ref_w = signals.P_ref,
    };
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance;
    return IEEE_Cigre_DLLInterface_Return_OK;
}
