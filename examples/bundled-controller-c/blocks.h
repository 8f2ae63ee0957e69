/* The control subsystem, one function a block: the same equations in the same order as the package's control/, where the
 * Python block of the same name says what each one is and where it comes from. The C twin of the benchmarks runs it, too.
 */
#pragma once

#include "current_references.h"

static inline double fll_step(SogiState x, vector e, double w, const FllParams *p, double T)
{
    double norm = dot(x.u, x.u) + dot(x.qu, x.qu);
    double w_next = w - T * p->gamma * p->K * w * dot(e, x.qu) / max(norm, p->norm_min);
    return min(max(w_next, p->w_min), p->w_max);
}

static inline Synchronisation msogi_fll_step(MsogiFllState *x, vector u_g_ab, const FllParams *p, double T)
{
    vector e = u_g_ab - (x->h1.u + x->h5.u + x->h7.u + x->h11.u + x->h13.u);
    Synchronisation seen = {
        .u_pos = positive_sequence(x->h1),
        .u_neg = negative_sequence(x->h1),
        .w = x->w,
        .turns = harmonic_turns(x->w * T),
    };
    x->w = fll_step(x->h1, e, x->w, p, T);
    x->h1 = sogi_step(x->h1, p->K * e, seen.turns.h1);
    x->h5 = sogi_step(x->h5, p->K / 5 * e, seen.turns.h5);
    x->h7 = sogi_step(x->h7, p->K / 7 * e, seen.turns.h7);
    x->h11 = sogi_step(x->h11, p->K / 11 * e, seen.turns.h11);
    x->h13 = sogi_step(x->h13, p->K / 13 * e, seen.turns.h13);
    return seen;
}

static inline double reactive_power_of_voltage(double V_fault, const LvrtParams *p)
{
    double slope = p->Q_full / (p->V_detect - p->V_full);
    return p->S_nom * min(max(slope * (p->V_detect - V_fault), 0.0), p->Q_full);
}

static inline LvrtOrder lvrt_step(vector u_pos, vector u_neg, const LvrtParams *p)
{
    double V_pos = length(u_pos) / p->u_nom, V_neg = length(u_neg) / p->u_nom;
    if (V_pos >= p->V_detect)
        return (LvrtOrder){.V_fault = V_pos, .fault = false, .P_limit = p->S_nom, .Q_ref = p->Q_set};
    double S_fault = max(V_pos - V_neg, 0.0) * p->S_nom;
    double Q = min(reactive_power_of_voltage(V_pos, p), S_fault);
    double P_fault = sqrt(max(S_fault * S_fault - Q * Q, 0.0));
    return (LvrtOrder){.V_fault = V_pos, .fault = true, .P_limit = P_fault, .Q_ref = Q};
}

static inline double dc_voltage_regulator_step(DcVoltageRegulatorState *x, double e, double P_limit, bool *limited,
                                               const DcVoltageRegulatorParams *p, double T)
{
    double wanted = p->K_P * e + x->integral;
    double P_ref = min(max(wanted, 0.0), P_limit);
    x->integral = P_ref - p->K_P * e + p->K_I * e * T;
    *limited = wanted > P_limit;
    return P_ref;
}

static inline void mppt_step(MpptState *x, double v_dc, double i_pv, bool limited, const MpptParams *p)
{
    if (limited) {
        *x = (MpptState){.v_ref = x->v_ref, .direction = x->direction, .k = 0, .energy = 0.0, .P_before = -1.0};
        return;
    }
    int64_t half = p->period / 2;
    if (x->k >= half)
        x->energy += v_dc * i_pv;
    if (++x->k < p->period)
        return;
    double P = x->energy / (double)(p->period - half);
    double direction = x->P_before > P ? -x->direction : x->direction;
    double v_ref = min(max(x->v_ref + direction * p->dv, p->v_min), p->v_max);
    *x = (MpptState){.v_ref = v_ref, .direction = direction, .k = 0, .energy = 0.0, .P_before = P};
}

/* Advances one resonator and returns its output `lead` samples ahead of the state before. */
static inline vector resonator_step(SogiState *x, vector e, double k, Rotation turn, int64_t lead)
{
    SogiState later = *x;
    for (int64_t n = 0; n < lead; n++)
        later = (SogiState){.u = turn.c * later.u - turn.s * later.qu, .qu = turn.s * later.u + turn.c * later.qu};
    *x = sogi_step(*x, k * (e - x->u), turn);
    return later.u;
}

static inline vector current_regulator_step(CurrentRegulatorState *x, vector e, const Synchronisation *grid,
                                            const CurrentRegulatorParams *p)
{
    double k = 2 * p->w_c / grid->w;
    vector m = p->K_P * e + p->K_I * resonator_step(&x->h1, e, k, grid->turns.h1, p->lead);
    m += p->K_I5 * resonator_step(&x->h5, e, k / 5, grid->turns.h5, p->lead);
    m += p->K_I7 * resonator_step(&x->h7, e, k / 7, grid->turns.h7, p->lead);
    m += p->K_I11 * resonator_step(&x->h11, e, k / 11, grid->turns.h11, p->lead);
    m += p->K_I13 * resonator_step(&x->h13, e, k / 13, grid->turns.h13, p->lead);
    return m;
}

static inline vector limited_to(double m_max, vector m)
{
    double size = length(m);
    return size <= m_max ? m : m_max / size * m;
}

static inline vector modulate(vector m, vector u_g_ab, double v_dc, const ModulatorParams *p)
{
    if (p->feedforward != 0.0)
        m += p->feedforward / (p->K_PWM * max(v_dc, 1.0)) * u_g_ab;
    return limited_to(p->m_max, m);
}

static inline ControllerSignals controller_step(ControllerState *x, Measured y, const ControllerParams *p)
{
    Synchronisation grid = msogi_fll_step(&x->sync.msogi, y.u_g_ab, &p->sync.fll, p->T);
    LvrtOrder order = lvrt_step(grid.u_pos, grid.u_neg, &p->lvrt);
    double v_ref = x->mppt.v_ref;
    bool limited;
    double P_ref =
        dc_voltage_regulator_step(&x->dc_voltage, y.v_dc - v_ref, order.P_limit, &limited, &p->dc_voltage, p->T);
    mppt_step(&x->mppt, y.v_dc, y.i_pv, limited, &p->mppt);
    vector i_ref = current_references(grid.u_pos, grid.u_neg, P_ref, order.Q_ref, &p->references);
    vector m = current_regulator_step(&x->current, i_ref - y.i_ab, &grid, &p->current);
    return (ControllerSignals){
        .m = modulate(m, y.u_g_ab, y.v_dc, &p->modulator),
        .V_fault = order.V_fault,
        .fault = order.fault,
        .w = grid.w,
        .v_ref = v_ref,
        .P_ref = P_ref,
        .Q_ref = order.Q_ref,
        .i_ref = i_ref,
    };
}
