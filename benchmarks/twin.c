/* The plant and the controller of the package once more, in C: the yardstick of speed.py.
 *
 * Same equations in the same order; the Python block of the same name says what each one is and where it comes from.
 * The controller is that of examples/bundled-controller-c. The structures and constants are in structures.h and
 * layout.h, which twin.py writes from the package's own.
 */
#include "blocks.h"
#include "twin_plant.h"

static inline void record_phases(double *a, double *b, double *c, vector ab, double zero)
{
    double along = SQRT2_3 * creal(ab), across = SQRT2_3 * SQRT3_2 * cimag(ab);
    *a = along + zero;
    *b = -0.5 * along + across + zero;
    *c = -0.5 * along - across + zero;
}

/* A channel lies in one piece of so many rows. */
static inline void record(double *row, int64_t rows, const PlantState *x, const Observed *y, const ControllerSignals *s,
                          double G)
{
    record_phases(row + rows * COLUMN_u_a_v, row + rows * COLUMN_u_b_v, row + rows * COLUMN_u_c_v, y->u_ab, y->u_zero);
    record_phases(row + rows * COLUMN_u0_a_v, row + rows * COLUMN_u0_b_v, row + rows * COLUMN_u0_c_v, y->u0_ab, y->u_zero);
    record_phases(row + rows * COLUMN_i_a_a, row + rows * COLUMN_i_b_a, row + rows * COLUMN_i_c_a, x->i, 0.0);
    row[rows * COLUMN_v_dc_v] = x->v_dc;
    row[rows * COLUMN_i_pv_a] = x->i_pv;
    row[rows * COLUMN_irradiance_w_m2] = 1000.0 * G;
    row[rows * COLUMN_connected] = x->closed;
    row[rows * COLUMN_trip_cause] = x->trip;
    row[rows * COLUMN_v_fault_pu] = s->V_fault;
    row[rows * COLUMN_fault_signal] = s->fault;
    row[rows * COLUMN_frequency_estimate_hz] = s->w / (2 * PI);
    row[rows * COLUMN_v_dc_ref_v] = s->v_ref;
    row[rows * COLUMN_p_ref_w] = s->P_ref;
    row[rows * COLUMN_q_ref_var] = s->Q_ref;
    row[rows * COLUMN_i_ref_alpha_a] = creal(s->i_ref);
    row[rows * COLUMN_i_ref_beta_a] = cimag(s->i_ref);
    row[rows * COLUMN_m_alpha] = creal(s->m);
    row[rows * COLUMN_m_beta] = cimag(s->m);
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
            return (Outcome){.status = NOT_FINITE, .period = n, .plant = plant};
        if (n >= 0)
            record(samples + n, count, &plant, &y, &signals, p->G);
        advance(&plant, m, source, t, p, tables);
        m = signals.m;
    }
    return (Outcome){.status = COMPLETED, .period = count, .plant = plant};
}
