/* LCL1000: what the controller computes in one sample, in per unit of its own bases. dll.c and fmu.c put it behind their
 * interfaces, lcl1000.py says the same in Python.
 *
 * Sequence filter at the base frequency, frequency from the turn of the positive sequence, under-voltage protection with
 * two delays, momentary cessation, active power by what is available and by the DC voltage, reactive current by the
 * depth of the sag, resonant control of the inverter-side current. Space vectors are as long as the amplitude of the
 * phases: u = 2/3 (u_a + u_b exp(j 120 deg) + u_c exp(j 240 deg)).
 */
#ifndef LCL1000_LAW_H
#define LCL1000_LAW_H

#include <complex.h>
#include <math.h>
#include <stdint.h>

#define SAMPLE_TIME 100e-6
#define PI 3.14159265358979323846
#define LEAST_VOLTAGE 0.1 /* pu: no current is made larger by less voltage, and no frequency is measured below */
#define LEAST_LENGTH 0.02 /* pu: below it the positive sequence has no direction */

typedef double complex Vector;

/* Ports and parameters: members in the order of the tables of either interface. */
typedef struct {
    double VCa, VCb, VCc; /* kV, filter capacitor */
    double VGa, VGb, VGc; /* kV, grid terminals */
    double I1a, I1b, I1c; /* kA, inverter side of the filter, out of the bridge */
    double I2a, I2b, I2c; /* kA, grid side, into the grid */
    double Vdc, Vdc_MPP;  /* kV */
    double P_avail;       /* MW */
    double P_request, Q_request; /* pu */
    int32_t Run, CB_closed;
} Inputs;

typedef struct {
    double Ea, Eb, Ec; /* kV, bridge to the middle of the link */
    int32_t TRIP, BLOCK;
    double Vpos, Vmin;             /* pu */
    double Freq;                   /* Hz */
    double P_meas, Q_meas;         /* MW, Mvar */
    double P_ref, Q_ref;           /* MW, Mvar */
} Outputs;

typedef struct {
    double VLLbase; /* V, rms */
    double Sbase;   /* kVA */
    double fbase;   /* Hz */
    double Imax;    /* pu */
    double R1, X1;  /* pu, inverter side of the filter */
    double Kp;      /* pu */
    double Ki;      /* pu/s */
    double Kdc;     /* pu of power per pu of Vdc_MPP */
    double Ksync;
    double Tfreq;         /* s */
    double Kfrt;          /* pu/pu */
    double Vlow, Vhigh;   /* pu */
    double P_ramp;        /* pu/s */
    double UV1_level, UV1_delay; /* pu, s */
    double UV2_level, UV2_delay;
    int32_t MC_enable;
    double MC_level, MC_release; /* pu, s */
} Parameters;

typedef struct {
    double pos_re, pos_im, neg_re, neg_im; /* sequences of the grid voltage, as they will be in the next sample (pu) */
    double slip;                           /* frequency beyond the base (rad/s) */
    double rp_re, rp_im, rn_re, rn_im;     /* resonators (pu) */
    double p;                              /* active power that was asked of the current (pu) */
} Numbers;

typedef struct {
    int32_t uv1, uv2;  /* samples below the levels */
    int32_t mc;        /* samples for which the bridge stays blocked */
    int32_t tripped;
    int32_t started;
} Counts;

typedef struct {
    Numbers x;
    Counts n;
} State;

static Vector law_turn(double angle) { return cexp(I * angle); }

static Vector law_vector(double a, double b, double c)
{
    return 2.0 / 3.0 * (a + law_turn(2 * PI / 3) * b + law_turn(-2 * PI / 3) * c);
}

static double law_within(double x, double least, double most) { return fmin(fmax(x, least), most); }

static double law_base_kv(const Parameters *p) { return sqrt(2.0 / 3.0) * p->VLLbase / 1000; }

static double law_base_ka(const Parameters *p) { return sqrt(2.0 / 3.0) * p->Sbase / p->VLLbase; }

static int32_t law_samples(double time_s) { return (int32_t)lround(time_s / SAMPLE_TIME); }

/* Begin in the steady state that the inputs show. */
static void law_begin(State *s, const Inputs *in, const Parameters *p)
{
    const Vector v = law_vector(in->VGa, in->VGb, in->VGc) / law_base_kv(p);
    const Vector i2 = law_vector(in->I2a, in->I2b, in->I2c) / law_base_ka(p);
    *s = (State){.x = {.pos_re = creal(v), .pos_im = cimag(v), .p = creal(v * conj(i2))}, .n = {.started = 1}};
}

/* Lowest voltage of a phase, from both sequences. */
static double law_lowest(Vector pos, Vector neg)
{
    double lowest = INFINITY;
    for (int k = -1; k <= 1; k++) {
        const Vector back = law_turn(-2 * PI / 3 * k);
        lowest = fmin(lowest, cabs(pos * back + conj(neg * back)));
    }
    return lowest;
}

/* Count samples below a level; whether that is longer than a delay. */
static int law_is_long_below(int32_t *count, double v, double level, double delay)
{
    *count = v < level ? *count + 1 : 0;
    return *count > law_samples(delay);
}

/* Trip and block; `acts` is 0 as long as the bridge does not follow. */
static void law_protect(Counts *n, Outputs *out, int acts, const Parameters *p)
{
    if (!acts) {
        n->uv1 = n->uv2 = n->mc = 0;
    } else {
        const int uv1 = law_is_long_below(&n->uv1, out->Vmin, p->UV1_level, p->UV1_delay);
        const int uv2 = law_is_long_below(&n->uv2, out->Vmin, p->UV2_level, p->UV2_delay);
        n->tripped = n->tripped || uv1 || uv2;
        if (p->MC_enable && out->Vmin < p->MC_level)
            n->mc = law_samples(p->MC_release) + 1;
        else if (n->mc > 0)
            n->mc--;
    }
    out->TRIP = n->tripped;
    out->BLOCK = n->tripped || n->mc > 0;
}

static void law_step(State *s, Outputs *out, const Inputs *in, const Parameters *p)
{
    Numbers *x = &s->x;
    const double kv = law_base_kv(p), ka = law_base_ka(p), w_base = 2 * PI * p->fbase;
    const Vector u = law_vector(in->VCa, in->VCb, in->VCc) / kv, v = law_vector(in->VGa, in->VGb, in->VGc) / kv;
    const Vector i1 = law_vector(in->I1a, in->I1b, in->I1c) / ka, i2 = law_vector(in->I2a, in->I2b, in->I2c) / ka;
    const Vector power = v * conj(i2);

    /* sequences, and the frequency from how far the positive one has turned beyond what the base frequency turns it */
    const Vector before = x->pos_re + I * x->pos_im, mirrored = x->neg_re + I * x->neg_im;
    const Vector correction = 0.5 * p->Ksync * w_base * SAMPLE_TIME * (v - before - mirrored);
    Vector pos = before + correction, neg = mirrored + correction;
    if (cabs(pos) > LEAST_VOLTAGE && cabs(before) > LEAST_VOLTAGE)
        x->slip += SAMPLE_TIME / p->Tfreq * (carg(pos * conj(before)) / SAMPLE_TIME - x->slip);
    const Vector ahead = law_turn(w_base * SAMPLE_TIME);
    x->pos_re = creal(pos * ahead), x->pos_im = cimag(pos * ahead);
    x->neg_re = creal(neg * conj(ahead)), x->neg_im = cimag(neg * conj(ahead));

    /* what the filter lags at another frequency than its own is put right */
    const double slip = law_within(x->slip, -0.1 * w_base, 0.1 * w_base), lag = slip / (0.5 * p->Ksync * w_base);
    pos *= 1 + I * lag;
    neg *= 1 - I * lag;
    out->Vpos = cabs(pos);
    out->Vmin = law_lowest(pos, neg);
    out->Freq = p->fbase + slip / (2 * PI);
    law_protect(&s->n, out, in->Run && in->CB_closed, p);
    const int works = in->Run && in->CB_closed && !out->BLOCK;

    /* references: reactive current first, active power with what is left of the limit */
    const double size = fmax(out->Vpos, LEAST_VOLTAGE);
    const double depth = fmax(p->Vlow - out->Vpos, 0) - fmax(out->Vpos - p->Vhigh, 0);
    const double iq = law_within(in->Q_request / size + p->Kfrt * depth, -p->Imax, p->Imax);
    const double by_dc = 1000 * in->P_avail / p->Sbase + p->Kdc * (in->Vdc / in->Vdc_MPP - 1);
    const double wanted = fmin(fmin(fmax(by_dc, 0), in->P_request), sqrt(p->Imax * p->Imax - iq * iq) * out->Vpos);
    x->p = works ? fmin(wanted, x->p + p->P_ramp * SAMPLE_TIME) : creal(power);
    const Vector i_ref = (x->p / size - I * iq) * pos / fmax(out->Vpos, LEAST_LENGTH);

    /* current control; what does not work follows the current that flows */
    const Vector turn = law_turn((w_base + slip) * SAMPLE_TIME), middle = law_turn(1.5 * (w_base + slip) * SAMPLE_TIME);
    const Vector error = works ? i_ref - i1 : 0;
    Vector rp = (p->R1 + I * p->X1) * i1, rn = 0;
    if (works) {
        rp = x->rp_re + I * x->rp_im + p->Ki * SAMPLE_TIME * error;
        rn = x->rn_re + I * x->rn_im + p->Ki * SAMPLE_TIME * error;
    }
    rp *= turn;
    rn *= conj(turn);
    x->rp_re = creal(rp), x->rp_im = cimag(rp), x->rn_re = creal(rn), x->rn_im = cimag(rn);
    /* the command acts between one and two samples later: until its middle the grid turns on */
    Vector e = u + (middle - 1) * pos + (conj(middle) - 1) * neg + p->Kp * error + rp + rn;
    const double most = in->Vdc / sqrt(3) / kv;
    if (cabs(e) > most)
        e *= most / cabs(e);

    out->Ea = kv * creal(e);
    out->Eb = kv * creal(e * law_turn(-2 * PI / 3));
    out->Ec = kv * creal(e * law_turn(2 * PI / 3));
    out->P_meas = creal(power) * p->Sbase / 1000;
    out->Q_meas = cimag(power) * p->Sbase / 1000;
    out->P_ref = x->p * p->Sbase / 1000;
    out->Q_ref = iq * out->Vpos * p->Sbase / 1000;
}

#endif
