"""The bundled controller behind the Python door: its own kernels, started in its own steady state."""

from numba.typed import List

from pvlvrt_compliance.control.controller import ControllerParams, ControllerState, controller_step
from pvlvrt_compliance.kernel import cached_kernel
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import (
    control_period_s,
    controller_params,
    plant_params,
    plant_tables,
    steady_state,
)
from pvlvrt_compliance.vectors import Phases, phases_of, scaled, vector_of


@cached_kernel
def kept(x: ControllerState, p: ControllerParams):
    """State and parameters in lists of compiled code: to hand them over at every step costs more than the step."""
    states, params = List(), List()
    states.append(x)
    params.append(p)
    return states, params


@cached_kernel
def advance(states, params, u: Phases, i: Phases, v_dc: float, i_pv: float):
    """Advance by one sample: modulating signals by half the link, what it believes, and the currents that it wants."""
    measured = Measured(u_g_ab=vector_of(u), i_ab=vector_of(i), v_dc=v_dc, i_pv=i_pv)
    states[0], signals = controller_step(states[0], measured, params[0])
    beliefs = (signals.V_fault, signals.Q_ref, signals.P_ref)
    return phases_of(scaled(4 / 3, signals.m)), beliefs, phases_of(signals.i_ref)


class Bundled:
    """Ready for the default scenarios at 50 Hz and 1000 W/m2, settled for 0.5 s."""

    sample_time_s = control_period_s(Parameters())

    def reset(self, nominal):  # noqa: ARG002 - the protocol's
        """Take the steady state that the bundled simulation starts from."""
        scenario, parameters = Scenario(sag=Sag(depth=0.9), duration_s=0.309), Parameters()
        plant, tables = plant_params(parameters, scenario), plant_tables(parameters, scenario)
        p = controller_params(parameters, scenario)
        calls = -(-0.5 // self.sample_time_s)
        start = steady_state(plant, tables.grid, p, scenario, -calls * self.sample_time_s)
        self.states, self.params = kept(start.controller, p)
        self.beliefs = (0.0, 0.0, 0.0)

    def step(self, y):
        """Advance by one sample."""
        u, i = Phases(y.u_a_v, y.u_b_v, y.u_c_v), Phases(y.i_a_a, y.i_b_a, y.i_c_a)
        m, self.beliefs, self.wanted = advance(self.states, self.params, u, i, y.v_dc_v, y.i_pv_a)
        return m

    def signals(self):
        """What it believes."""
        return dict(zip(("v_fault_pu", "q_ref_var", "p_ref_w"), self.beliefs, strict=True))
