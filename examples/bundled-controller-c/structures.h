/* Structures and constants of the package's controller; written by benchmarks/twin.py from its own. */
#pragma once

typedef struct { double c; double s; } Rotation;
typedef struct { Rotation h1; Rotation h5; Rotation h7; Rotation h11; Rotation h13; } Turns;
typedef struct { double complex u_pos; double complex u_neg; double w; Turns turns; } Synchronisation;
typedef struct { double V_fault; bool fault; double P_limit; double Q_ref; } LvrtOrder;
typedef struct { double complex u_g_ab; double complex i_ab; double v_dc; double i_pv; } Measured;
typedef struct { double complex m; double V_fault; bool fault; double w; double v_ref; double P_ref; double Q_ref; double complex i_ref; } ControllerSignals;
typedef struct { double complex u; double complex qu; } SogiState;
typedef struct { SogiState h1; SogiState h5; SogiState h7; SogiState h11; SogiState h13; double w; } MsogiFllState;
typedef struct { MsogiFllState msogi; } SynchronisationState;
typedef struct { double integral; } DcVoltageRegulatorState;
typedef struct { double v_ref; double direction; int64_t k; double energy; double P_before; } MpptState;
typedef struct { SogiState h1; SogiState h5; SogiState h7; SogiState h11; SogiState h13; } CurrentRegulatorState;
typedef struct { SynchronisationState sync; DcVoltageRegulatorState dc_voltage; MpptState mppt; CurrentRegulatorState current; } ControllerState;
typedef struct { double K; double gamma; double w_min; double w_max; double norm_min; } FllParams;
typedef struct { double K_P; double K_I; double w_min; double w_max; double u_min; } PllParams;
typedef struct { PllParams pll; double K; } SrfPllParams;
typedef struct { PllParams pll; double ratio; } DdsrfPllParams;
typedef struct { int64_t algorithm; FllParams fll; SrfPllParams srf; DdsrfPllParams ddsrf; PllParams dsc; } SynchronisationParams;
typedef struct { double S_nom; double u_nom; double V_detect; double V_full; double Q_full; double Q_set; } LvrtParams;
typedef struct { double K_P; double K_I; } DcVoltageRegulatorParams;
typedef struct { int64_t period; double dv; double v_min; double v_max; } MpptParams;
typedef struct { int64_t strategy; double u_pos_less_neg_min; } CurrentReferenceParams;
typedef struct { double K_P; double K_I; double K_I5; double K_I7; double K_I11; double K_I13; double w_c; int64_t lead; } CurrentRegulatorParams;
typedef struct { double K_PWM; double m_max; double feedforward; } ModulatorParams;
typedef struct { SynchronisationParams sync; LvrtParams lvrt; DcVoltageRegulatorParams dc_voltage; MpptParams mppt; CurrentReferenceParams references; CurrentRegulatorParams current; ModulatorParams modulator; double T; } ControllerParams;
#define PI 0x1.921fb54442d18p+1
#define SQRT2_3 0x1.a20bd700c2c3ep-1
#define SQRT3_2 0x1.bb67ae8584caap-1
#define BRIDGE_GAIN 0x1.5555555555555p-1
#define M_MAX 0x1.0f876ccdf6cd9p+0
