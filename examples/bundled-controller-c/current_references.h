/* Reference of the current vector (A) from the sequences of the voltage (V), P* (W) and Q* (var). */
#pragma once

#include "vectors.h"

static inline vector current_references(vector u_pos, vector u_neg, double P_ref, double Q_ref,
                                        const CurrentReferenceParams *p)
{
    if (length(u_pos) - length(u_neg) < p->u_pos_less_neg_min)
        return 0.0;
    double D = dot(u_pos, u_pos) - dot(u_neg, u_neg);
    return P_ref / D * (u_pos - u_neg) - Q_ref / D * ahead(u_pos + u_neg);
}
