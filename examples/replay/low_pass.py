"""A low-pass filter for three phases: as little as a controller can be that has vectors of its own (vectors.csv)."""


class LowPass:
    """A Butterworth filter of second order, 500 Hz at 10 kHz, on the three phase voltages, as modulating signals."""

    sample_time_s = 100e-6

    # H(z) = gain (b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2), of a voltage in units of 400 V
    gain = 1.0
    b0, b1, b2 = 0.020083365564211232, 0.040166731128422464, 0.020083365564211232
    a1, a2 = -1.5610180758007182, 0.6413515380575631

    def reset(self, nominal):
        """Start at rest; a filter has no use for the rating."""
        del nominal
        self.states = [[0.0, 0.0] for _ in range(3)]

    def step(self, y):
        """One sample of each phase, in the transposed second direct form."""
        return tuple(map(self.filtered, (y.u_a_v, y.u_b_v, y.u_c_v), self.states))

    def filtered(self, u, state):
        """One sample of one phase."""
        x = self.gain * u / 400
        out = self.b0 * x + state[0]
        state[0] = self.b1 * x - self.a1 * out + state[1]
        state[1] = self.b2 * x - self.a2 * out
        return out
