/* A small controller of a grid-connected PV inverter that rides through voltage sags.
 *
 * Synchronisation (a DSOGI with a frequency-locked loop), DC-voltage control, reactive power by the depth of the sag,
 * references for constant active power, and resonant current control. Space vectors are complex numbers as long as the
 * amplitude of the phases: u = 2/3 (u_a + u_b exp(j 120 deg) + u_c exp(j 240 deg)).
 *
 * Everything that is remembered is in State, which lies in the state array of the instance.
 */
#include "ieee_cigre.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#define SAMPLE_TIME 100e-6
#define PI 3.14159265358979323846
#define COUNT(array) (int32_T)(sizeof(array) / sizeof((array)[0]))

typedef double complex Vector;

/* Ports and parameters: members in the order of the tables below. */
typedef struct {
    real64_T Va, Vb, Vc, Ia, Ib, Ic, Vdc, Snom, Vnom, fnom;
} Inputs;

typedef struct {
    real64_T ma, mb, mc, v_fault_pu, q_ref_var, p_ref_w;
} Outputs;

typedef struct {
    real64_T dc_voltage_v, dc_proportional_w_per_v, dc_integral_w_per_vs;
    real64_T current_proportional_ohm, current_resonant_ohm_per_s;
    real64_T dsogi_gain, fll_gain;
    real64_T fault_threshold_pu, plateau_voltage_pu, plateau_power_pu;
} Parameters;

typedef struct {
    Vector u_pos, u_neg;  /* sequences of the grid's voltage (V) */
    Vector r_pos, r_neg;  /* resonators of the current control (V) */
    double w;             /* frequency (rad/s); 0 before the first sample */
    double p_integral;    /* of the DC-voltage control (W) */
    double hold;          /* 1: the outputs were set by the tool, and do not act yet */
} State;

#define PORT(name, unit, words) {#name, words, unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 1}

static const IEEE_Cigre_DLLInterface_Signal inputs_info[] = {
    PORT(Va, "V", "grid voltage, phase to neutral"),
    PORT(Vb, "V", "grid voltage, phase to neutral"),
    PORT(Vc, "V", "grid voltage, phase to neutral"),
    PORT(Ia, "A", "current into the grid"),
    PORT(Ib, "A", "current into the grid"),
    PORT(Ic, "A", "current into the grid"),
    PORT(Vdc, "V", "DC-link voltage"),
    PORT(Snom, "VA", "rating"),
    PORT(Vnom, "V", "rated voltage, phase to neutral, rms"),
    PORT(fnom, "Hz", "rated frequency"),
};

static const IEEE_Cigre_DLLInterface_Signal outputs_info[] = {
    PORT(ma, "", "modulating signal: u_a = ma Vdc / 2"),
    PORT(mb, "", "modulating signal"),
    PORT(mc, "", "modulating signal"),
    PORT(v_fault_pu, "pu", "positive sequence of the grid's voltage"),
    PORT(q_ref_var, "var", "reference of reactive power"),
    PORT(p_ref_w, "W", "reference of active power"),
};

#define PARAMETER(name, unit, words, value, least, most)                                                              \
    {#name, "control", words, unit, IEEE_Cigre_DLLInterface_DataType_real64_T, 0, {.Real64_Val = value},              \
     {.Real64_Val = least}, {.Real64_Val = most}}

static const IEEE_Cigre_DLLInterface_Parameter parameters_info[] = {
    PARAMETER(dc_voltage_v, "V", "at which the array gives its most", 807, 600, 1000),
    PARAMETER(dc_proportional_w_per_v, "W/V", "of the DC-voltage control", 4000, 0, 1e6),
    PARAMETER(dc_integral_w_per_vs, "W/(V s)", "of the DC-voltage control", 150e3, 0, 1e8),
    PARAMETER(current_proportional_ohm, "ohm", "filter inductance by 2 pi 400 Hz", 0.38, 0, 10),
    PARAMETER(current_resonant_ohm_per_s, "ohm/s", "of either sequence", 60, 0, 1e5),
    PARAMETER(dsogi_gain, "", "of the synchronisation", 1.414, 0.1, 4),
    PARAMETER(fll_gain, "1/s", "of the synchronisation", 50, 0, 1000),
    PARAMETER(fault_threshold_pu, "pu", "a fault below it", 0.85, 0.5, 1),
    PARAMETER(plateau_voltage_pu, "pu", "full reactive power below it", 0.5, 0, 0.49),
    PARAMETER(plateau_power_pu, "pu", "full reactive power", 0.75, 0, 1),
};

static const IEEE_Cigre_DLLInterface_Model_Info info = {
    .DLLInterfaceVersion = {1, 1, 0, 0},
    .ModelName = "small-controller",
    .ModelVersion = "0.1.0",
    .ModelDescription = "A small controller of a PV inverter that rides through voltage sags",
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
    .NumDoubleStates = sizeof(State) / sizeof(double),
};

static Vector turned(double angle) { return cexp(I * angle); }

static Vector vector(double a, double b, double c)
{
    return 2.0 / 3.0 * (a + turned(2 * PI / 3) * b + turned(-2 * PI / 3) * c);
}

static double limited(double x, double least, double most) { return fmin(fmax(x, least), most); }

static double squared(Vector x) { return creal(x) * creal(x) + cimag(x) * cimag(x); }

/* Follow the sequences of the voltage, one oscillator each, and the frequency. */
static void synchronise(State *x, Vector u, const Inputs *in, const Parameters *p)
{
    const double w_nominal = 2 * PI * in->fnom, least = 0.1 * sqrt(2) * in->Vnom;
    const Vector error = u - x->u_pos - x->u_neg;
    const double gain = 0.5 * p->dsogi_gain * x->w * SAMPLE_TIME;
    x->u_pos += gain * error;
    x->u_neg += gain * error;
    const double size = 2 * (squared(x->u_pos) + squared(x->u_neg));
    if (size > least * least) {
        const Vector quadrature = -I * (x->u_pos - x->u_neg);
        const double slip = creal(error * conj(quadrature)) / size;
        x->w -= SAMPLE_TIME * p->fll_gain * p->dsogi_gain * x->w * slip;
        x->w = limited(x->w, 0.9 * w_nominal, 1.1 * w_nominal);
    }
}

/* Active power from the DC voltage, reactive power from the depth of the sag; within the rating. */
static void set_powers(State *x, Outputs *out, const Inputs *in, const Parameters *p)
{
    const double voltage = sqrt(2) * in->Vnom;
    const double pos = cabs(x->u_pos) / voltage, neg = cabs(x->u_neg) / voltage;
    const double most = limited(pos - neg, 0, 1) * in->Snom; /* what nominal current carries */
    const double depth = (p->fault_threshold_pu - pos) / (p->fault_threshold_pu - p->plateau_voltage_pu);
    const double q = fmin(p->plateau_power_pu * limited(depth, 0, 1) * in->Snom, most);
    const double p_most = sqrt(most * most - q * q);
    const double error = in->Vdc - p->dc_voltage_v;
    x->p_integral += p->dc_integral_w_per_vs * SAMPLE_TIME * error;
    x->p_integral = limited(x->p_integral, 0, p_most);
    out->p_ref_w = limited(x->p_integral + p->dc_proportional_w_per_v * error, 0, p_most);
    out->q_ref_var = q;
    out->v_fault_pu = pos;
}

/* Sinusoidal currents that carry constant active power also in an unbalanced grid. */
static Vector current_reference(const State *x, const Outputs *out, const Inputs *in)
{
    const double size = squared(x->u_pos) - squared(x->u_neg), least = 0.01 * sqrt(2) * in->Vnom;
    if (size < least * least)
        return 0;
    return 2.0 / 3.0 * (out->p_ref_w * (x->u_pos - x->u_neg) - I * out->q_ref_var * (x->u_pos + x->u_neg)) / size;
}

/* Voltage of the bridge: the grid's, and what a resonator for either sequence adds. */
static Vector regulate(State *x, Vector error, Vector u, Vector turn, const Parameters *p)
{
    const double gain = p->current_resonant_ohm_per_s * SAMPLE_TIME;
    x->r_pos += gain * error;
    x->r_neg += gain * error;
    x->r_pos *= turn;
    x->r_neg *= conj(turn);
    return u + p->current_proportional_ohm * error + x->r_pos + x->r_neg;
}

static void step(State *x, Outputs *out, const Inputs *in, const Parameters *p)
{
    const Vector u = vector(in->Va, in->Vb, in->Vc), i = vector(in->Ia, in->Ib, in->Ic);
    const Vector turn = turned(x->w * SAMPLE_TIME);
    synchronise(x, u, in, p);
    if (x->hold != 0)
        x->p_integral = 1.5 * creal(u * conj(i));
    set_powers(x, out, in, p);
    const Vector error = current_reference(x, out, in) - i;
    if (x->hold != 0) { /* what modulates now is what the resonator has to go on with */
        const Vector acting = vector(out->ma, out->mb, out->mc) * in->Vdc / 2;
        x->r_pos = acting - (u + p->current_proportional_ohm * error) * conj(turn);
        x->r_neg = 0;
    }
    const Vector m = regulate(x, error, u, turn, p) * 2 / fmax(in->Vdc, 1);
    out->ma = creal(m);
    out->mb = creal(m * turned(-2 * PI / 3));
    out->mc = creal(m * turned(2 * PI / 3));
    x->u_pos *= turn;
    x->u_neg *= conj(turn);
}

const IEEE_Cigre_DLLInterface_Model_Info *Model_GetInfo(void) { return &info; }

int32_T Model_PrintInfo(void) { return IEEE_Cigre_DLLInterface_Return_OK; }

int32_T Model_CheckParameters(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance; /* the tool has checked the ranges */
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Initialize(IEEE_Cigre_DLLInterface_Instance *instance)
{
    const Inputs *in = instance->ExternalInputs;
    State x;
    memcpy(&x, instance->DoubleStates, sizeof x);
    if (x.w == 0)
        x.w = 2 * PI * in->fnom;
    x.hold = 1;
    memcpy(instance->DoubleStates, &x, sizeof x);
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Outputs(IEEE_Cigre_DLLInterface_Instance *instance)
{
    State x;
    memcpy(&x, instance->DoubleStates, sizeof x);
    step(&x, instance->ExternalOutputs, instance->ExternalInputs, instance->Parameters);
    x.hold = 0;
    memcpy(instance->DoubleStates, &x, sizeof x);
    return IEEE_Cigre_DLLInterface_Return_OK;
}

int32_T Model_Terminate(IEEE_Cigre_DLLInterface_Instance *instance)
{
    (void)instance;
    return IEEE_Cigre_DLLInterface_Return_OK;
}
