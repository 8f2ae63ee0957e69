/* The plant and the controller of the package once more, in C: the yardstick of speed.py.
 *
 * Same equations in the same order; the Python block of the same name says what each one is and where it comes from.
 * The controller is that of examples/bundled-controller-c. The structures and constants are in structures.h and
 * layout.h, which twin.py writes from the package's own.
 */
#include "blocks.h"
#include "twin_plant.h"

static inline double *record_phases(double *row, vector ab, double zero)
{
    double along = SQRT2_3 * creal(ab), across = SQRT2_3 * SQRT3_2 * cimag(ab);
    row[0] = along + zero;
    row[1] = -0.5 * along + across + zero;
    row[2] = -0.5 * along - across + zero;
    return row + 3;
}

static inline void record(double *row, const PlantState *x, const Observed *y, const ControllerSignals *s, double G)
{
    row = record_phases(row, y->u_ab, y->u_zero);
    row = record_phases(row, y->u0_ab, y->u_zero);
    row = record_phases(row, x->i, 0.0);
    const double rest[] = {
        x->v_dc,  x->i_pv,           1000.0 * G,       x->closed,  x->trip, s->V_fault, s->fault, s->w / (2 * PI),
        s->v_ref, s->P_ref,          s->Q_ref,         creal(s->i_ref), cimag(s->i_ref), creal(s->m), cimag(s->m),
    };
    _Static_assert(9 + sizeof rest / sizeof *rest == CHANNELS, "one number a channel");
    for (unsigned k = 0; k < sizeof rest / sizeof *rest; k++)
        row[k] = rest[k];
}

static inline bool finite_numbers(const PlantState *x, const ControllerSignals *s)
{
    return isfinite(x->v_dc + creal(x->i) + cimag(x->i) + x->i_pv + creal(s->m) + cimag(s->m) + s->w + s->P_ref +
                    s->v_ref);
}

Outcome run(const PlantState *plant_start, const ControllerState *controller_start, const vector *m_start,
            int64_t first, const PlantParams *params, const PlantTables *tables, const ControllerParams *controller_params,
            double *samples, int64_t count)
{
    PlantState plant = *plant_start;
    ControllerState controller = *controller_start;
    PlantParams now = *params, *p = &now;
    vector m = *m_start;
    double T_reg = (double)p->ratio * p->T_S;
    int64_t k_grid = 0;
    for (int64_t n = first; n < count; n++) {
        double t = (double)n * T_reg;
        Source source = source_at(t, k_grid, &tables->grid);
        k_grid = source.k;
        as_at(p, t, k_grid, tables);
        Observed y = observe(&plant, m, &source, p);
        Measured sampled = {.u_g_ab = y.u_ab, .i_ab = plant.i, .v_dc = plant.v_dc, .i_pv = plant.i_pv};
        ControllerSignals signals = controller_step(&controller, sampled, controller_params);
        if (!finite_numbers(&plant, &signals))
            return (Outcome){.status = NOT_FINITE, .periods = n > 0 ? n : 0, .plant = plant};
        if (n >= 0)
            record(samples + CHANNELS * n, &plant, &y, &signals, p->G);
        advance(&plant, m, source, t, p, tables);
        m = signals.m;
    }
    return (Outcome){.status = COMPLETED, .periods = count, .plant = plant};
}
