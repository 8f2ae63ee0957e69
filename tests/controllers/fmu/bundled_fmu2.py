"""The bundled controller as an FMU of FMI 2, by pythonfmu. It is imported from the tests beside it, not packed."""

import sys
from pathlib import Path

from pythonfmu import DefaultExperiment, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

import pvlvrt_compliance

sys.path.insert(0, str(Path(pvlvrt_compliance.__file__).parents[1] / "tests" / "controllers"))
from bundled import Bundled

INPUTS = ("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "v_dc_v", "i_pv_a")
OUTPUTS = ("m_a", "m_b", "m_c", "v_fault_pu")


class BundledFmu(Fmi2Slave):
    """Its outputs are those of `Bundled`."""

    default_experiment = DefaultExperiment(step_size=Bundled.sample_time_s)

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in INPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in OUTPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        self.share = 1.0
        self.register_variable(Real("share", causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))
        self.controller = Bundled()

    def exit_initialization_mode(self):
        """Start anew."""
        self.controller.reset(None)

    def do_step(self, current_time, step_size):  # noqa: ARG002 (names are those of pythonfmu)
        """Advance by one sample."""
        m = self.controller.step(self)
        self.m_a, self.m_b, self.m_c = (self.share * x for x in m)
        self.v_fault_pu = self.controller.signals()["v_fault_pu"]
        return True
