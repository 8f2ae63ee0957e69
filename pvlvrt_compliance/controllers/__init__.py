"""What a controller of your own looks like in Python: `Controller`, what it is told and what it gives.

A class in a file of yours, named on the command line as ``--controller my_ctrl.py:MyController``.
"""

from typing import NamedTuple, Protocol, runtime_checkable

from pvlvrt_compliance.units import Nominal

__all__ = ["Controller", "Measurements", "Nominal"]


class Measurements(NamedTuple):
    """What a controller reads once a sample time; instantaneous values, with the sensors' errors if there are any.

    A tuple of floats, so that a function compiled by numba takes it as it is.
    """

    time_s: float  # since the controller's first sample (s)
    u_a_v: float  # voltage at the PCC, phase to neutral (V)
    u_b_v: float
    u_c_v: float
    i_a_a: float  # current into the grid (A)
    i_b_a: float
    i_c_a: float
    v_dc_v: float  # DC-link voltage (V)
    i_dc_a: float  # current from the link into the bridge (A)
    i_pv_a: float  # current from the array into the link (A)
    m_a: float  # what modulates at this instant: the command of some samples ago (-)
    m_b: float
    m_c: float
    enabled: float  # 0: commands do not act yet, the inverter stays in its steady state; 1: they act
    connected: float  # 0: the breaker is open
    irradiance_w_m2: float
    p_set_w: float  # active power that is asked for: what the array can give, at most the nominal (W)
    q_set_var: float  # set-point of reactive power outside of faults, positive: into the grid as a capacitor does (var)
    frequency_nominal_hz: float
    apparent_power_nominal_va: float
    voltage_nominal_v: float  # phase to neutral, rms (V)
    p_available_w: float = 0.0  # most that the array can give at this irradiance (W)
    slow_task_due: float = 1.0  # 1 in every n-th sample, n being the attribute ``every``; 0 in between
    v_dc_nominal_v: float = 0.0  # of the array's maximum-power point at 1000 W/m2, 25 C (V)
    filter_inductance_h: float = 0.0
    filter_resistance_ohm: float = 0.0
    dc_link_capacitance_f: float = 0.0


@runtime_checkable
class Controller(Protocol):
    """A controller: the class is called without arguments, or with those that ``--set controller.NAME=`` gives.

    It may have a method ``signals() -> dict[str, float]`` besides, asked after `reset` and after every `step`, always
    with the same keys: they become channels of the record. A key ends in its unit (``p_ref_w``); ``v_fault_pu``,
    ``q_ref_var`` and ``p_ref_w`` are shown beside the measurements, as of the bundled controller.

    It may have an attribute ``commands_voltages = True``: `step` then returns the voltages (V) that it wants, phase to
    the middle of the DC link, and the host divides by half of the link's voltage as sampled.

    It may have an attribute ``switches = ("trip", "block")``, one or more of ``trip``, ``block`` and ``restart``:
    `step` then returns their values behind the three, in that order, true or false. A trip opens the breaker for good,
    with the controller named as the cause. A block turns no device of the bridge on, for as long as it is commanded; of
    a controller that has a restart, until that is commanded and the block is not.

    It may have an attribute ``every = 25`` and a method ``step_slow(measurements)``, called before `step` in its first
    sample and every 25th after it: a slow task beside the fast one, at a whole multiple of the sample time.

    Keyword arguments of the class that have defaults are its parameters; without any, its public attributes that are
    numbers, words or switches. A parameter keeps the type of its default.

    It starts at rest and sees the steady state of normal operation at first (``enabled`` 0, as long as
    `simulation.synchronising_s`): it can synchronise and set its regulators to what modulates (``m_a``, ``m_b``,
    ``m_c``).
    """

    sample_time_s: float
    """From one call of `step` to the next (s)."""

    def reset(self, nominal: Nominal) -> None:
        """Start anew, for an inverter of this rating; called once before the first `step`."""

    def step(self, measurements: Measurements) -> tuple[float, float, float]:
        """Modulating signals of the three phases from one sample: u_a = m_a v_DC / 2.

        They act one sample time later, held until the next (`controller.computation_delay_samples`), and are limited
        to the linear range with zero-sequence injection, an amplitude of 2 / sqrt(3); their zero sequence drops out.
        """
