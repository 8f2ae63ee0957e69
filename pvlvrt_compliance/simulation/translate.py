"""The one place where words with units become the symbols of the kernels, and where a run's first state is made."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.control import current_references, dc_voltage_regulator, fll, mppt, pll, synchronisation
from pvlvrt_compliance.control.controller import ControllerParams, ControllerState, Precision
from pvlvrt_compliance.control.current_references import CurrentReferenceParams
from pvlvrt_compliance.control.current_regulator import CurrentRegulatorParams, at_rest_regulator
from pvlvrt_compliance.control.dc_voltage_regulator import DcVoltageRegulatorParams
from pvlvrt_compliance.control.ddsrf_pll import DdsrfPllParams
from pvlvrt_compliance.control.lvrt import LvrtParams
from pvlvrt_compliance.control.modulator import ModulatorParams
from pvlvrt_compliance.control.mppt import MpptParams
from pvlvrt_compliance.control.parameters import ControllerParameters, PowerStrategy, SynchronisationName
from pvlvrt_compliance.control.srf_pll import SrfPllParams
from pvlvrt_compliance.control.synchronisation import SynchronisationParams
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.kernel import plain
from pvlvrt_compliance.plant import pv_array
from pvlvrt_compliance.plant.grid import GridTable
from pvlvrt_compliance.plant.inverter import K_PWM, M_MAX
from pvlvrt_compliance.plant.plant import PlantParams, PlantState, PlantTables
from pvlvrt_compliance.plant.protection import NO_TRIP, ProtectionParams, UndervoltageCurve, relays_at_rest
from pvlvrt_compliance.plant.pv_array import STC_IRRADIANCE, PvParams
from pvlvrt_compliance.plant.switched_bridge import DeviceParams, PeriodMean
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.surroundings import (
    grid_table,
    harmonic_table,
    irradiance_table,
    line_of,
    line_table,
    playback_table,
)
from pvlvrt_compliance.sogi import in_steady_state
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.vectors import rotation

_SWITCHED_REFERENCE_VA = 800.0 * 1000.0  # voltage and current that the switching energy is given for (V A)
_FREQUENCY_BAND_HZ = 5.0  # default setting of the frequency relay around nominal

_STRATEGIES: Mapping[PowerStrategy, int] = {
    "constant-p-q": current_references.CONSTANT_P_Q,
    "constant-p-light-q": current_references.CONSTANT_P_LIGHT_Q,
    "constant-p-sinusoidal": current_references.CONSTANT_P_SINUSOIDAL,
    "constant-q": current_references.CONSTANT_Q,
    "balanced": current_references.BALANCED,
}
_ALGORITHMS: Mapping[SynchronisationName, int] = {
    "msogi-fll": synchronisation.MSOGI_FLL,
    "dsogi-fll": synchronisation.DSOGI_FLL,
    "srf-pll": synchronisation.SRF_PLL,
    "ddsrf-pll": synchronisation.DDSRF_PLL,
    "dsc-pll": synchronisation.DSC_PLL,
}


class Start(NamedTuple):
    """State of everything at the beginning of the unrecorded settling."""

    plant: PlantState
    controller: ControllerState
    m: complex  # modulating signal of the first period (-)
    u_g_ab: complex  # grid voltage (V)


def nominal_of(parameters: Parameters, scenario: Scenario) -> Nominal:
    """Rating of the plant: the base of per-unit values."""
    return Nominal(
        apparent_power_va=1e3 * parameters.plant.apparent_power_kva,
        phase_voltage_v=parameters.plant.phase_voltage_v,
        frequency_hz=scenario.nominal_frequency_hz,
    )


def pv_params(parameters: Parameters, scenario: Scenario) -> PvParams:
    """PV array at the scenario's cell temperature."""
    p = parameters.plant
    return pv_array.fit(pv_array.STP320_24_VE, scenario.cell_temperature_c, p.modules_in_series, p.strings_in_parallel)


def plant_step_s(parameters: Parameters) -> float:
    """T_S (s)."""
    return 1e-6 * parameters.simulation.plant_step_us


def control_period_s(parameters: Parameters) -> float:
    """T_reg (s)."""
    return parameters.simulation.control_ratio * plant_step_s(parameters)


def protection_params(parameters: Parameters, nominal: Nominal) -> ProtectionParams:
    """Settings of the relays."""
    p = parameters.protection
    low = nominal.frequency_hz - _FREQUENCY_BAND_HZ if p.frequency_min_hz is None else p.frequency_min_hz
    high = nominal.frequency_hz + _FREQUENCY_BAND_HZ if p.frequency_max_hz is None else p.frequency_max_hz
    w_nom = 2 * math.pi * nominal.frequency_hz
    return ProtectionParams(
        i_max=p.overcurrent_pu * nominal.phase_current_peak_a,
        v_dc_max=p.dc_overvoltage_v,
        u_nom=nominal.voltage_ab_v,
        u_low=p.undervoltage_curve[-1][1],
        curve_delay=p.undervoltage_delay_s,
        w_nom=w_nom,
        w_min=-math.inf if p.frequency_relay is False else 2 * math.pi * low,
        w_max=math.inf if p.frequency_relay is False else 2 * math.pi * high,
        t_frequency=p.frequency_delay_s,
        turn=plain(rotation)(w_nom * plant_step_s(parameters)),
    )


def device_params(parameters: Parameters) -> DeviceParams:
    """Dead time and losses of the switched inverter."""
    p = parameters.plant
    return DeviceParams(
        t_dead=1e-6 * p.dead_time_us,
        v_drop=p.device_drop_v,
        t_loss=1e-3 * p.switching_energy_mj / _SWITCHED_REFERENCE_VA,
    )


def plant_params(parameters: Parameters, scenario: Scenario) -> PlantParams:
    """Parameters of the plant in one scenario."""
    p = parameters.plant
    nominal = nominal_of(parameters, scenario)
    T_S = plant_step_s(parameters)
    return PlantParams(
        pv=pv_params(parameters, scenario),
        line=line_of(parameters, nominal, scenario.scr, scenario.xr, T_S),
        protection=protection_params(parameters, nominal),
        devices=device_params(parameters) if parameters.simulation.fidelity == "switched" else None,
        C=p.dc_link_capacitance_f,
        G=scenario.irradiance_w_m2 / STC_IRRADIANCE,
        t_breaker=p.breaker_opening_s,
        T_S=T_S,
        ratio=parameters.simulation.control_ratio,
    )


def plant_tables(parameters: Parameters, scenario: Scenario) -> PlantTables:
    """What the plant looks up: the events of grid and weather, and the undervoltage curve."""
    nominal = nominal_of(parameters, scenario)
    T_S = plant_step_s(parameters)
    protection = parameters.protection
    curve = np.array(protection.undervoltage_curve, dtype=np.float64)
    if protection.undervoltage_relay is False:
        curve[:, 1] = 0.0  # no voltage is below it; what the last level is besides, in `protection_params`, stays
    return PlantTables(
        grid=grid_table(scenario, nominal, T_S),
        harmonics=harmonic_table(scenario, nominal),
        playback=playback_table(scenario),
        lines=line_table(scenario, parameters, nominal, T_S),
        irradiance=irradiance_table(scenario),
        undervoltage=UndervoltageCurve(t=curve[:, 0].copy(), u=curve[:, 1].copy()),
    )


def synchronisation_params(c: ControllerParameters, u_nom: float) -> SynchronisationParams:
    """Parameters of every synchronisation, and which is chosen; ``u_nom`` is |u_ab| nominal (V)."""
    guards = (c.fll_frequency_min_hz, c.fll_frequency_max_hz, u_nom)
    loop = pll.design(c.pll_bandwidth_hz, c.pll_damping, *guards)
    return SynchronisationParams(
        algorithm=_ALGORITHMS[c.synchronisation],
        fll=fll.design(c.sogi_gain, c.fll_gain, *guards),
        srf=SrfPllParams(pll=loop, K=2 * c.pnsd_notch_damping),
        ddsrf=DdsrfPllParams(pll=loop, ratio=c.ddsrf_filter_ratio),
        dsc=loop,
    )


def controller_params(parameters: Parameters, scenario: Scenario) -> ControllerParams:
    """Parameters of the controller."""
    c = parameters.controller
    nominal = nominal_of(parameters, scenario)
    T_reg = control_period_s(parameters)
    u_nom = nominal.voltage_ab_v
    return ControllerParams(
        sync=synchronisation_params(c, u_nom),
        lvrt=LvrtParams(
            S_nom=nominal.apparent_power_va,
            u_nom=u_nom,
            V_detect=c.fault_threshold_pu,
            V_full=c.reactive_plateau_voltage_pu,
            Q_full=c.reactive_plateau_pu,
            Q_set=scenario.reactive_power_pu * nominal.apparent_power_va,
        ),
        dc_voltage=DcVoltageRegulatorParams(K_P=c.dc_proportional_gain_w_per_v, K_I=c.dc_integral_gain_w_per_vs),
        mppt=MpptParams(
            period=max(round(c.mppt_period_s / T_reg), 2),
            dv=c.mppt_step_v,
            v_min=c.mppt_voltage_min_v,
            v_max=c.mppt_voltage_max_v,
        ),
        references=CurrentReferenceParams(
            strategy=_STRATEGIES[c.power_strategy],
            u_pos_less_neg_min=c.sequence_difference_min_pu * u_nom,
        ),
        current=CurrentRegulatorParams(
            K_P=c.pr_proportional_gain,
            K_I=c.pr_integral_gain,
            K_I5=c.hc5_integral_gain,
            K_I7=c.hc7_integral_gain,
            K_I11=c.hc11_integral_gain,
            K_I13=c.hc13_integral_gain,
            w_c=c.pr_cutoff_rad_s,
            lead=c.resonator_lead_samples,
        ),
        modulator=ModulatorParams(K_PWM=K_PWM, m_max=M_MAX, feedforward=float(c.grid_voltage_feedforward)),
        T=T_reg,
        precision=Precision(double=True, single=None),
    )


def steady_state(
    plant: PlantParams, grid: GridTable, controller: ControllerParams, scenario: Scenario, t: float
) -> Start:
    """Normal operation at the instant ``t`` (s): the maximum-power point, or S_nom right of it.

    The regulators' resonators start where the inverter balances the grid voltage; what is left of the transient
    (losses, resonant error) settles before the record begins.

    Raises
    ------
    SimulationError
        When there is none in finite numbers: a voltage of the DC link that the array never has.
    """
    try:
        return _steady_state(plant, grid, controller, scenario, t)
    except ArithmeticError:
        raise SimulationError("there is no steady state in finite numbers to begin from") from None


def _steady_state(
    plant: PlantParams, grid: GridTable, controller: ControllerParams, scenario: Scenario, t: float
) -> Start:
    best = pv_array.maximum_power_point(scenario.irradiance_w_m2, plant.pv)
    P = min(best.p, controller.lvrt.S_nom)
    v_dc = max(pv_array.voltage_at_power(P, scenario.irradiance_w_m2, plant.pv), controller.mppt.v_min)
    v_ref = min(max(best.v, controller.mppt.v_min), controller.mppt.v_max)
    w = float(grid.w[0])
    theta = float(grid.theta[0] + w * (t - grid.t[0]))
    u = controller.lvrt.u_nom * complex(math.cos(theta), math.sin(theta))
    i = P / abs(u) ** 2 * u
    m = u / (K_PWM * v_dc)
    i_pv = pv_array.current_at(v_dc, scenario.irradiance_w_m2, plant.pv)
    regulator = at_rest_regulator()
    if controller.current.K_I > 0:
        regulator = regulator._replace(h1=in_steady_state(m / controller.current.K_I))
    return Start(
        plant=PlantState(
            i=i,
            v_dc=v_dc,
            x_pv=v_dc / plant.pv.n_series + plant.pv.R_s * i_pv / plant.pv.n_parallel,
            i_pv=i_pv,
            relay=relays_at_rest(u, w),
            trip=NO_TRIP,
            t_trip=0.0,
            closed=True,
            blocked=False,
            mean=PeriodMean(u=K_PWM * v_dc * m, i=i),
        ),
        controller=ControllerState(
            sync=synchronisation.locked(u, w, controller.sync, controller.T),
            dc_voltage=dc_voltage_regulator.settled(P, v_dc, v_ref, controller.dc_voltage),
            mppt=mppt.searching_from(v_ref),
            current=regulator,
        ),
        m=m,
        u_g_ab=u,
    )
