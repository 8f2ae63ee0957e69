"""The controller as an FMU (FMI 2, co-simulation): its ports and parameters are variables of the same names."""

from controller import Controller
from pythonfmu import DefaultExperiment, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

INPUTS = {
    "u_a_v": "grid voltage, phase to neutral (V)",
    "u_b_v": "grid voltage, phase to neutral (V)",
    "u_c_v": "grid voltage, phase to neutral (V)",
    "i_a_a": "current into the grid (A)",
    "i_b_a": "current into the grid (A)",
    "i_c_a": "current into the grid (A)",
    "v_dc_v": "DC-link voltage (V)",
    "m_a": "what modulates now",
    "m_b": "what modulates now",
    "m_c": "what modulates now",
    "enabled": "0: commands do not act yet",
    "apparent_power_va": "rating (VA)",
    "phase_voltage_v": "rated voltage, phase to neutral, rms (V)",
    "frequency_hz": "rated frequency (Hz)",
}
OUTPUTS = {
    "m_a_ref": "modulating signal: u_a = m_a v_DC / 2",
    "m_b_ref": "modulating signal",
    "m_c_ref": "modulating signal",
    "v_fault_pu": "positive sequence of the grid's voltage (pu)",
    "q_ref_var": "reference of reactive power (var)",
    "p_ref_w": "reference of active power (W)",
}


class MyController(Fmi2Slave):
    """Advances the controller by one sample at every step."""

    default_experiment = DefaultExperiment(step_size=Controller.sample_time_s)

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.controller = None
        for name, description in INPUTS.items():
            self._add(name, description, 0.0, Fmi2Causality.input)
        for name, description in OUTPUTS.items():
            self._add(name, description, 0.0, Fmi2Causality.output)
        self.parameters = tuple(vars(Controller()))
        for name, value in vars(Controller()).items():
            self._add(name, "", value, Fmi2Causality.parameter)

    def _add(self, name, description, value, causality):
        setattr(self, name, value)
        tunable = Fmi2Variability.tunable if causality == Fmi2Causality.parameter else Fmi2Variability.continuous
        self.register_variable(Real(name, causality=causality, variability=tunable, description=description))

    def do_step(self, current_time, step_size):  # noqa: ARG002 - names that pythonfmu wants
        """Advance by one sample; with the first one the rating is known."""
        if self.controller is None:
            self.controller = Controller(**{name: getattr(self, name) for name in self.parameters})
            self.controller.reset(self)
        self.m_a_ref, self.m_b_ref, self.m_c_ref = self.controller.step(self)
        for name, value in self.controller.signals().items():
            setattr(self, name, value)
        return True
