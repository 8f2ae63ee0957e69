/* A controller of a PV inverter in a program of its own, which talks by packed frames.
 *
 *     gcc -O2 -o controller controller.c -lm
 *     pvlvrt-check --controller "stdio:./controller" --sag 60%
 *
 * The hello and the start are lines of JSON, which it need not understand: it always says the same and takes its rating
 * from its inputs. Then frames go to and fro: the length in bytes (4 bytes), then float64 numbers, all little-endian as
 * this machine is. It synchronises by a DSOGI at the nominal frequency, holds the DC voltage, gives reactive power by the
 * depth of a sag, and regulates the currents by resonators. Space vectors are as long as the amplitude of the phases.
 */
#include <complex.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define SAMPLE_TIME_S 100e-6

typedef double complex vector_t;

static const double PI = 3.14159265358979323846;

/* The names in the hello stand in the same order. */
typedef struct {
    double u_v[3], i_a[3], m[3];
    double v_dc_v, enabled, frequency_hz, power_va, voltage_v;
} inputs_t;

typedef struct {
    double m[3], v_fault_pu;
} outputs_t;

static const char HELLO[] =
    "{\"version\": 1, \"name\": \"program-c 1.0\", \"sample_time_s\": 100e-6, \"mode\": \"binary\", \"inputs\": ["
    "\"u_a_v\", \"u_b_v\", \"u_c_v\", \"i_a_a\", \"i_b_a\", \"i_c_a\", \"m_a\", \"m_b\", \"m_c\", \"v_dc_v\", "
    "\"enabled\", \"frequency_nominal_hz\", \"apparent_power_nominal_va\", \"voltage_nominal_v\"], "
    "\"outputs\": [\"m_a\", \"m_b\", \"m_c\", \"v_fault_pu\"]}\n";

typedef struct {
    vector_t u_pos, u_neg; /* sequences of the grid's voltage (V) */
    vector_t r_pos, r_neg; /* resonators of the current control (V) */
    double p_integral;     /* of the DC-voltage control (W) */
} state_t;

static double within(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static vector_t turned(double angle) { return cos(angle) + I * sin(angle); }

static vector_t vector_of(const double x[3])
{
    return 2.0 / 3.0 * (x[0] + turned(2 * PI / 3) * x[1] + turned(-2 * PI / 3) * x[2]);
}

/* Currents of constant active power, within the rating, from the DC voltage and the depth of the sag. */
static vector_t current_reference(state_t *s, const inputs_t *y, double voltage)
{
    double pos = cabs(s->u_pos), neg = cabs(s->u_neg), size = pos * pos - neg * neg;
    if (size < 1e-4 * voltage * voltage)
        return 0;
    double most = within((pos - neg) / voltage, 0, 1); /* what nominal current carries (pu) */
    double q = within(2.14 * (0.85 - pos / voltage), 0, fmin(0.75, most));
    double p_most = sqrt(most * most - q * q) * y->power_va;
    double error = y->v_dc_v - 807.0;
    s->p_integral = within(s->p_integral + 150e3 * SAMPLE_TIME_S * error, 0, p_most);
    double p = within(s->p_integral + 4000.0 * error, 0, p_most);
    return 2.0 / 3.0 * (p * (s->u_pos - s->u_neg) - I * q * y->power_va * (s->u_pos + s->u_neg)) / size;
}

static void step(state_t *s, const inputs_t *y, outputs_t *out)
{
    double angle = 2 * PI * y->frequency_hz * SAMPLE_TIME_S, voltage = sqrt(2.0) * y->voltage_v;
    vector_t turn = turned(angle), u = vector_of(y->u_v), i = vector_of(y->i_a);
    vector_t missed = u - s->u_pos - s->u_neg;
    s->u_pos += 0.7 * angle * missed;
    s->u_neg += 0.7 * angle * missed;
    if (y->enabled == 0)
        s->p_integral = 1.5 * creal(u * conj(i));
    vector_t error = current_reference(s, y, voltage) - i;
    if (y->enabled == 0) { /* what modulates now is what the resonator has to go on with */
        s->r_pos = vector_of(y->m) * y->v_dc_v / 2 * turn - u - 0.38 * error;
        s->r_neg = 0;
    }
    s->r_pos = (s->r_pos + 60.0 * SAMPLE_TIME_S * error) * turn;
    s->r_neg = (s->r_neg + 60.0 * SAMPLE_TIME_S * error) / turn;
    vector_t m = (u + 0.38 * error + s->r_pos + s->r_neg) * 2 / fmax(y->v_dc_v, 1.0);
    for (int k = 0; k < 3; k++)
        out->m[k] = creal(m * turned(-2 * PI / 3 * k));
    out->v_fault_pu = cabs(s->u_pos) / voltage;
    s->u_pos *= turn;
    s->u_neg /= turn;
}

/* Wait for a line that has a word; 0 at the end. */
static int await(const char *word)
{
    static char line[1 << 16];
    while (fgets(line, sizeof line, stdin))
        if (strstr(line, word))
            return 1;
        else if (strstr(line, "\"end\""))
            return 0;
    return 0;
}

int main(void)
{
    state_t state = {0};
    inputs_t in;
    struct {
        uint32_t unused, length; /* so that the numbers follow the length without a gap */
        outputs_t out;
    } reply = {0, sizeof reply.out, {{0}, 0}};
    uint32_t length;

    if (!await("\"protocol\""))
        return 1;
    fputs(HELLO, stdout);
    fflush(stdout);
    if (!await("\"start\""))
        return 0;
    fputs("{\"ready\": true}\n", stdout);
    fflush(stdout);
    while (fread(&length, sizeof length, 1, stdin) == 1 && length == sizeof in) {
        if (fread(&in, sizeof in, 1, stdin) != 1)
            return 1;
        step(&state, &in, &reply.out);
        fwrite(&reply.length, sizeof reply.length + sizeof reply.out, 1, stdout);
        fflush(stdout);
    }
    return length == 0 ? 0 : 1;
}
