/* The power subsystem: the files of plant/, one function a block. */
#pragma once

#include "vectors.h"

#include "layout.h"
#include "twin_diodes.h"

static inline Source source_at(double t, int64_t k, const GridTable *table)
{
    int64_t last = table->size - 1;
    while (k < last && t >= table->t[k + 1])
        k++;
    double since = t - table->t[k];
    double theta = table->theta[k] + (table->w[k] + 0.5 * table->dw[k] * since) * since;
    vector half_rate = table->half_rate[k];
    if (table->dw[k] != 0.0) {
        double more = table->dw[k] * since * table->half_step;
        half_rate *= CMPLX(cos(more), sin(more));
    }
    return (Source){
        .k = k,
        .t_end = k < last ? table->t[k + 1] : INFINITY,
        .u_pos = table->u_pos[k] + since * table->du_pos[k],
        .u_neg = table->u_neg[k] + since * table->du_neg[k],
        .u_zero = table->u_zero[k] + since * table->du_zero[k],
        .turn = CMPLX(cos(theta), sin(theta)),
        .half_rate = half_rate,
        .du_pos = table->half_step * table->du_pos[k],
        .du_neg = table->half_step * table->du_neg[k],
    };
}

static inline void later(Source *x, vector by, double halves)
{
    x->u_pos += halves * x->du_pos;
    x->u_neg += halves * x->du_neg;
    x->turn *= by;
}

static inline double irradiance_at(double t, const IrradianceTable *table)
{
    double G = table->G[table->size - 1];
    for (int64_t k = table->size - 1; k > 0; k--)
        if (t < table->t[k])
            G = table->G[k - 1] + (t - table->t[k - 1]) / (table->t[k] - table->t[k - 1]) * (table->G[k] - table->G[k - 1]);
    return G;
}

static inline void as_at(PlantParams *p, double t, int64_t k, const PlantTables *tables)
{
    const LineTable *lines = &tables->lines;
    p->line = (LineParams){
        .decay = lines->decay[k], .gain = lines->gain[k], .k_u = lines->k_u[k], .k_e = lines->k_e[k], .k_i = lines->k_i[k],
    };
    p->G = irradiance_at(t, &tables->irradiance);
}

static inline vector source_voltage(const Source *x) { return x->u_pos * x->turn + x->u_neg * conj(x->turn); }

static inline Bridge modulated(vector m, vector i, double v_dc)
{
    return (Bridge){.u = BRIDGE_GAIN * v_dc * m, .i_dc = BRIDGE_GAIN * dot(m, i)};
}

static inline bool is_blocked(const PlantState *x) { return x->blocked || x->trip != NO_TRIP; }

static inline vector terminal_voltage(const PlantState *x, vector i, vector u_inv, vector e, const LineParams *p)
{
    bool conducting = x->closed && (!is_blocked(x) || i != 0.0);
    return conducting ? p->k_u * u_inv + p->k_e * e + p->k_i * i : e;
}

static inline Observed observe(const PlantState *x, vector m, const Source *source, const PlantParams *p)
{
    vector e = source_voltage(source);
    vector u_inv = is_blocked(x) ? blocked_voltage(x->i, e, x->v_dc)
                                 : modulated(limited_to(M_MAX, m), x->i, x->v_dc).u;
    return (Observed){
        .u_ab = terminal_voltage(x, x->i, u_inv, e, &p->line),
        .u0_ab = e,
        .u_zero = creal(source->u_zero * source->turn),
    };
}

static inline double diode_voltage(double v, double G, double x, const PvParams *p)
{
    double per_a = 1 / p->a, G_s = 1 / p->R_s, G_sh = p->G_sh * G;
    double source = p->I_L * G + p->I_0 + v / p->n_series * G_s;
    for (int n = 0; n < NEWTON_STEPS; n++) {
        double diode = p->I_0 * exp(x * per_a);
        double dx = (source - diode - (G_sh + G_s) * x) / (diode * per_a + G_sh + G_s);
        x += dx;
        if (fabs(dx) < NEWTON_TOLERANCE)
            break;
    }
    return x;
}

static inline bool exceeds(vector i, double i_max)
{
    if (SQRT2_3 * SQRT2_3 * dot(i, i) <= i_max * i_max)
        return false;
    double along = -0.5 * creal(i), across = SQRT3_2 * cimag(i);
    return SQRT2_3 * max(max(fabs(creal(i)), fabs(along + across)), fabs(along - across)) > i_max;
}

static inline double undervoltage_limit(const RelayState *x, const ProtectionParams *p, const UndervoltageCurve *curve)
{
    double t = x->t_low - p->curve_delay;
    double level = curve->u[curve->size - 1];
    for (int64_t k = curve->size - 1; k > 0; k--)
        if (t < curve->t[k]) {
            double share = max((t - curve->t[k - 1]) / (curve->t[k] - curve->t[k - 1]), 0.0);
            level = curve->u[k - 1] + share * (curve->u[k] - curve->u[k - 1]);
        }
    return level;
}

static inline int64_t relays_step(RelayState *x, vector u, vector i, double v_dc, double u_min,
                                  const ProtectionParams *p, double T_S)
{
    vector e = u - x->cell.u, u_pos = positive_sequence(x->cell);
    double square = dot(u_pos, u_pos);
    double w_now = p->w_nom + 0.5 * RELAY_K * p->w_nom * cross(u_pos, e) / max(square, RELAY_SMALL * p->u_nom * p->u_nom);
    x->w += T_S / FREQUENCY_FILTER * (w_now - x->w);
    bool low = square < (p->u_low * p->u_nom) * (p->u_low * p->u_nom);
    x->t_low = low ? x->t_low + T_S : 0.0;
    bool off = !low && (x->w < p->w_min || x->w > p->w_max);
    x->t_off = off ? x->t_off + T_S : 0.0;
    x->cell = sogi_step(x->cell, RELAY_K * e, p->turn);
    if (exceeds(i, p->i_max))
        return OVERCURRENT;
    if (v_dc > p->v_dc_max)
        return DC_OVERVOLTAGE;
    if (low && square < (u_min * p->u_nom) * (u_min * p->u_nom))
        return UNDERVOLTAGE;
    return x->t_off >= p->t_frequency ? FREQUENCY : NO_TRIP;
}

static inline void plant_step(PlantState *x, vector m, vector e, double u_min, const PlantParams *p)
{
    double per_farad = p->T_S / p->C;
    bool tripped = x->trip != NO_TRIP;
    vector i = x->i, i_mid, u_inv;
    double v_mid, v_dc = x->v_dc, fed = 0.0;
    if (is_blocked(x)) {
        if (!x->closed)
            i = 0.0;
        blocked_flow(&i, &v_dc, &u_inv, &i_mid, x->i_pv, x->closed ? e : 0.0, p);
        v_mid = 0.5 * (x->v_dc + v_dc);
        fed = x->i_pv;
    } else {
        v_mid = max(x->v_dc + 0.5 * per_farad * (x->i_pv - modulated(m, x->i, x->v_dc).i_dc), 0.0);
        u_inv = modulated(m, x->i, v_mid).u;
        i = x->closed ? p->line.decay * x->i + p->line.gain * (u_inv - e) : 0.0;
        i_mid = 0.5 * (x->i + i);
        v_dc -= per_farad * modulated(m, i_mid, v_mid).i_dc;
    }
    x->x_pv = diode_voltage(v_mid, p->G, x->x_pv, &p->pv);
    x->i_pv = p->pv.n_parallel * (x->x_pv - v_mid / p->pv.n_series) / p->pv.R_s;
    x->v_dc = max(v_dc + per_farad * (x->i_pv - fed), 0.0);
    vector u_pcc = terminal_voltage(x, i_mid, u_inv, e, &p->line);
    int64_t trip = relays_step(&x->relay, u_pcc, i, x->v_dc, u_min, &p->protection, p->T_S);
    x->i = i;
    x->t_trip = tripped ? x->t_trip + p->T_S : 0.0;
    if (!tripped)
        x->trip = trip;
    x->closed = x->closed && !(tripped && (i == 0.0 || x->t_trip > p->t_breaker));
}

static inline void advance(PlantState *x, vector m, Source source, double t, const PlantParams *p,
                           const PlantTables *tables)
{
    m = limited_to(M_MAX, m);
    double u_min = undervoltage_limit(&x->relay, &p->protection, &tables->undervoltage);
    vector rate = source.half_rate * source.half_rate;
    later(&source, source.half_rate, 1.0);
    for (int64_t n = 0; n < p->ratio; n++) {
        double t_mid = t + ((double)n + 0.5) * p->T_S;
        if (n > 0)
            later(&source, rate, 2.0);
        if (t_mid >= source.t_end) {
            source = source_at(t_mid, source.k, &tables->grid);
            rate = source.half_rate * source.half_rate;
        }
        plant_step(x, m, source_voltage(&source), u_min, p);
    }
}
