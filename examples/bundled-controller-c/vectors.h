/* Space vectors and second-order generalised integrators: vectors.py and sogi.py. */
#pragma once

#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "structures.h"

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

typedef double complex vector;

static inline double max(double a, double b) { return a > b ? a : b; }
static inline double min(double a, double b) { return a < b ? a : b; }
static inline double dot(vector a, vector b) { return creal(a) * creal(b) + cimag(a) * cimag(b); }
static inline double cross(vector a, vector b) { return creal(a) * cimag(b) - cimag(a) * creal(b); }
static inline double length(vector z) { return sqrt(dot(z, z)); }
static inline vector ahead(vector z) { return CMPLX(-cimag(z), creal(z)); }

static inline Rotation rotate_on(Rotation r, Rotation by)
{
    return (Rotation){.c = r.c * by.c - r.s * by.s, .s = r.s * by.c + r.c * by.s};
}

static inline Turns harmonic_turns(double angle)
{
    Rotation r1 = {.c = cos(angle), .s = sin(angle)};
    Rotation r2 = rotate_on(r1, r1), r4 = rotate_on(r2, r2);
    Rotation r5 = rotate_on(r4, r1), r7 = rotate_on(r5, r2), r11 = rotate_on(r7, r4);
    return (Turns){.h1 = r1, .h5 = r5, .h7 = r7, .h11 = r11, .h13 = rotate_on(r11, r2)};
}

static inline SogiState sogi_step(SogiState x, vector forcing, Rotation turn)
{
    vector q = x.qu - forcing;
    return (SogiState){.u = turn.c * x.u - turn.s * q, .qu = forcing + turn.s * x.u + turn.c * q};
}

static inline vector positive_sequence(SogiState x) { return 0.5 * (x.u + ahead(x.qu)); }
static inline vector negative_sequence(SogiState x) { return 0.5 * (x.u - ahead(x.qu)); }

/* Vector of phase quantities, power-invariant; their zero sequence drops out. */
static inline vector vector_of(double a, double b, double c)
{
    return CMPLX(SQRT2_3 * (a - 0.5 * b - 0.5 * c), SQRT2_3 * SQRT3_2 * (b - c));
}

/* Phase quantities of a vector, without zero sequence. */
static inline void phases_of(vector z, double *phases)
{
    double along = SQRT2_3 * creal(z), across = SQRT2_3 * SQRT3_2 * cimag(z);
    phases[0] = along;
    phases[1] = -0.5 * along + across;
    phases[2] = -0.5 * along - across;
}
