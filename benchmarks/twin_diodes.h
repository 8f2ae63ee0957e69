/* The blocked bridge: plant/diode_bridge.py in loops over the phases. */
#pragma once

#include "vectors.h"

#include "layout.h"

typedef struct {
    double of[3];
} Three;

static inline Three three_of(vector z)
{
    double along = SQRT2_3 * creal(z), across = SQRT2_3 * SQRT3_2 * cimag(z);
    return (Three){{along, -0.5 * along + across, -0.5 * along - across}};
}

static inline vector of_three(Three x)
{
    return CMPLX(SQRT2_3 * (x.of[0] - 0.5 * x.of[1] - 0.5 * x.of[2]), SQRT2_3 * SQRT3_2 * (x.of[1] - x.of[2]));
}

/* What conducts in each phase: 1 the upper diode, -1 the lower, 0 neither. */
static Three conducting(Three i, Three e, double v)
{
    Three s;
    int on = 0;
    for (int k = 0; k < 3; k++) {
        s.of[k] = fabs(i.of[k]) <= NO_CURRENT ? 0.0 : (i.of[k] > 0.0 ? -1.0 : 1.0);
        on += s.of[k] != 0.0;
    }
    if (on == 0) {
        int most = 0, least = 0;
        for (int k = 1; k < 3; k++) {
            if (e.of[k] > e.of[most])
                most = k;
            if (e.of[k] < e.of[least])
                least = k;
        }
        if (e.of[most] - e.of[least] > v) {
            s.of[most] = 1.0;
            s.of[least] = -1.0;
        }
    }
    for (int k = 0; k < 3; k++) /* the potential of a phase without current, between two that conduct */
        if (s.of[k] == 0.0 && s.of[(k + 1) % 3] * s.of[(k + 2) % 3] < 0.0 && fabs(1.5 * e.of[k]) > 0.5 * v) {
            s.of[k] = e.of[k] > 0.0 ? 1.0 : -1.0;
            break;
        }
    return s;
}

/* Those that are on, less what they have in common. */
static Three balanced(Three x, Three on)
{
    double sum = 0.0, count = 0.0;
    for (int k = 0; k < 3; k++)
        if (on.of[k] != 0.0) {
            sum += x.of[k];
            count += 1.0;
        }
    for (int k = 0; k < 3; k++)
        x.of[k] = count < 2.0 || on.of[k] == 0.0 ? 0.0 : x.of[k] - sum / count;
    return x;
}

static vector against(Three s, Three e, double v)
{
    Three d;
    for (int k = 0; k < 3; k++)
        d.of[k] = 0.5 * v * s.of[k] - e.of[k];
    return of_three(balanced(d, s));
}

static vector blocked_voltage(vector i, vector e, double v_dc)
{
    Three source = three_of(e);
    return e + against(conducting(three_of(i), source, v_dc), source, v_dc);
}

static double blocked_dc_current(vector i)
{
    Three x = three_of(i);
    return -0.5 * (fabs(x.of[0]) + fabs(x.of[1]) + fabs(x.of[2]));
}

static vector line_part(vector i, vector u, double share, const LineParams *p)
{
    double exponent = log(p->decay);
    double part = exponent < 0.0 ? expm1(share * exponent) / expm1(exponent) : share;
    return exp(share * exponent) * i + part * p->gain * u;
}

/* Line and link over one plant step; the mean voltage and the mean current are left in `u` and `i_mid`. */
static void blocked_flow(vector *i, double *v_dc, vector *u, vector *i_mid, double i_pv, vector e, const PlantParams *p)
{
    Three source = three_of(e);
    double left = 1.0;
    *u = *i_mid = 0.0;
    for (int part = 0; part < MOST_PARTS && left > 0.0; part++) {
        double v = max(*v_dc + 0.5 * left * p->T_S / p->C * (i_pv - blocked_dc_current(*i)), 0.0);
        Three now = three_of(*i), s = conducting(now, source, v), ends;
        vector driving = against(s, source, v);
        Three then = three_of(line_part(*i, driving, left, &p->line));
        double share = 1.0;
        for (int k = 0; k < 3; k++) {
            if (s.of[k] == 0.0 || then.of[k] * s.of[k] <= 0.0)
                ends.of[k] = 2.0;
            else
                ends.of[k] = now.of[k] * s.of[k] >= 0.0 ? 0.0 : now.of[k] / (now.of[k] - then.of[k]);
            if (ends.of[k] < share)
                share = ends.of[k];
        }
        if (part == MOST_PARTS - 1)
            share = 1.0;
        double length = share * left;
        then = three_of(line_part(*i, driving, length, &p->line));
        for (int k = 0; k < 3; k++)
            if (ends.of[k] <= share || then.of[k] * s.of[k] >= -NO_CURRENT)
                then.of[k] = 0.0;
        vector next = of_three(balanced(then, then));
        double i_dc = 0.5 * (blocked_dc_current(*i) + blocked_dc_current(next));
        *v_dc = max(*v_dc + length * p->T_S / p->C * (i_pv - i_dc), 0.0);
        *u += length * (e + driving);
        *i_mid += 0.5 * length * (*i + next);
        *i = next;
        left -= length;
    }
}
