"""A controller that records what it is told, and holds what modulates."""


class Informed:
    """Open loop."""

    sample_time_s = 1e-3

    def reset(self, nominal):  # noqa: ARG002 - the protocol's
        """Nothing has been told."""
        self.told = dict.fromkeys(("p_set_w", "p_available_w", "v_nominal_v", "l_h", "r_ohm", "c_f"), 0.0)

    def step(self, y):
        """Hold."""
        self.told = {
            "p_set_w": y.p_set_w,
            "p_available_w": y.p_available_w,
            "v_nominal_v": y.v_dc_nominal_v,
            "l_h": y.filter_inductance_h,
            "r_ohm": y.filter_resistance_ohm,
            "c_f": y.dc_link_capacitance_f,
        }
        return y.m_a, y.m_b, y.m_c

    def signals(self):
        """What it was told last."""
        return self.told
