"""Every number of a record, and of what a controller from outside is given, stands in the place of its name."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.control.controller import ControllerSignals
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant.plant import Observed, PlantState
from pvlvrt_compliance.plant.protection import relays_at_rest
from pvlvrt_compliance.plant.switched_bridge import PeriodMean
from pvlvrt_compliance.simulation.columns import (
    CHANNELS,
    PLANT_CHANNELS,
    RECORDED,
    phases_at,
    put_phases,
    record_controller,
    record_plant,
)
from pvlvrt_compliance.simulation.door.call import out_of_the_frame, put_commands, put_signals
from pvlvrt_compliance.simulation.door.controller import record_foreign
from pvlvrt_compliance.simulation.door.exchange import (
    COMMANDED_M,
    COMMANDED_U,
    COMMANDS,
    IGNORED_AT,
    IGNORED_STATUS,
    LATEST_CALL,
    PROGRESSES,
    SIGNALS,
    SWITCHES,
    TRIP_SEEN,
    FixedSignals,
    LaterSignals,
)

PLANT = PlantState(
    i=900 + 350j,
    v_dc=812.0,
    x_pv=36.0,
    i_pv=601.0,
    relay=relays_at_rest(398 + 0j, 314.0),
    trip=3,
    t_trip=0.02,
    closed=True,
    blocked=False,
    mean=PeriodMean(u=0j, i=0j),
)
OBSERVED = Observed(u_ab=390 - 80j, u0_ab=370 + 55j, u_zero=17.0)
SIGNALS_OUT = ControllerSignals(
    m=0.8 - 0.3j,
    V_fault=0.71,
    fault=True,
    w=2 * math.pi * 49.3,
    v_ref=799.0,
    P_ref=4.1e5,
    Q_ref=1.2e5,
    i_ref=880 + 210j,
)
G = 0.63


def phases(names, ab, zero=0.0):
    """Three phases of a vector, by name: sqrt(2/3) of its part along each phase's axis, and the zero sequence."""
    axes = [cmath.rect(1.0, 2 * math.pi * k / 3) for k in range(3)]
    return {
        name: math.sqrt(2 / 3) * (ab * axis.conjugate()).real + zero for name, axis in zip(names, axes, strict=True)
    }


OF_THE_PLANT = {
    **phases(("u_a_v", "u_b_v", "u_c_v"), OBSERVED.u_ab, 17.0),
    **phases(("u0_a_v", "u0_b_v", "u0_c_v"), OBSERVED.u0_ab, 17.0),
    **phases(("i_a_a", "i_b_a", "i_c_a"), PLANT.i),
    **{"v_dc_v": 812.0, "i_pv_a": 601.0, "irradiance_w_m2": 630.0, "connected": 1.0, "trip_cause": 3.0},
}
OF_THE_CONTROLLER = {
    **{"v_fault_pu": 0.71, "fault_signal": 1.0, "frequency_estimate_hz": 49.3, "v_dc_ref_v": 799.0},
    **{"p_ref_w": 4.1e5, "q_ref_var": 1.2e5, "i_ref_alpha_a": 880.0, "i_ref_beta_a": 210.0},
    **{"m_alpha": 0.8, "m_beta": -0.3},
}


def by_name(names, row):
    """Numbers of a row by the names of its columns."""
    return dict(zip(names, row.tolist(), strict=True))


def test_every_channel_stands_in_its_column(in_python):
    """One sample of distinct numbers: each is found under its name, and no column is left out."""
    row = np.full(len(CHANNELS), np.nan)
    in_python(record_plant)(row, PLANT, OBSERVED, G)
    in_python(record_controller)(row, SIGNALS_OUT)
    assert by_name(CHANNELS, row) == pytest.approx({**OF_THE_PLANT, **OF_THE_CONTROLLER})


def test_every_channel_of_a_controller_from_outside_stands_in_its_column(in_python):
    """The plant's channels stand where they always do, then what modulates, then signals of the controller's own."""
    own = ("of_its_own", "and_another")
    row = np.full(len(RECORDED) + len(own), np.nan)
    in_python(record_plant)(row, PLANT, OBSERVED, G)
    commands = np.array([-1.0] * len(COMMANDS) + [7.0, 8.0])
    in_python(record_foreign)(row, 0.8 - 0.3j, commands)
    expected = {**OF_THE_PLANT, "m_alpha": 0.8, "m_beta": -0.3, "of_its_own": 7.0, "and_another": 8.0}
    assert by_name((*RECORDED, *own), row) == pytest.approx(expected)


def test_numbers_of_the_samples_are_distinct():
    """No two columns could be taken for one another here."""
    assert len({round(x, 6) for x in {**OF_THE_PLANT, **OF_THE_CONTROLLER}.values()} - {1.0}) == len(CHANNELS) - 2
    assert tuple(OF_THE_PLANT) == PLANT_CHANNELS


def test_every_signal_stands_in_its_place(in_python):
    """What a controller is given, one number a name; the bridge draws u . i / v_DC, and the rest stays as it is."""
    x = np.full(len(SIGNALS), np.nan)
    seen = Measured(u_g_ab=OBSERVED.u_ab, i_ab=PLANT.i, v_dc=813.0, i_pv=602.0)
    conducting = PLANT._replace(trip=0)
    m = 0.8 - 0.3j
    in_python(put_signals)(x, 1.25, seen, 17.0, conducting, m, G, 0.5)
    found = by_name(SIGNALS, x)
    fixed = ["p_set_w", *FixedSignals._fields, *LaterSignals._fields]
    assert [name for name, value in found.items() if math.isnan(value)] == fixed
    # The paper's signal is 3/4 of one by half the link, phase to its middle, in length: u = m v_DC / 2.
    acting = phases(("m_a", "m_b", "m_c"), 4 / 3 * m)
    powers = [0.5 * 812.0 * acting[f"m_{x}"] * OF_THE_PLANT[f"i_{x}_a"] for x in "abc"]
    assert {name: found[name] for name in SIGNALS if name not in fixed} == pytest.approx(
        {
            "time_s": 1.25,
            **phases(("u_a_v", "u_b_v", "u_c_v"), OBSERVED.u_ab, 17.0),
            **phases(("i_a_a", "i_b_a", "i_c_a"), PLANT.i),
            **{"v_dc_v": 813.0, "i_dc_a": sum(powers) / 812.0, "i_pv_a": 602.0},
            **acting,
            **{"enabled": 0.5, "connected": 1.0, "irradiance_w_m2": 630.0},
        }
    )


def test_every_command_stands_in_its_place(in_python):
    """What modulates, as three signals by half the link, and as three voltages; the switches are off."""
    x = np.full(len(COMMANDS), np.nan)
    in_python(put_commands)(x, 0.6 + 0.2j, 800.0)
    modulating = phases(("m_a", "m_b", "m_c"), 4 / 3 * (0.6 + 0.2j))
    volts = {f"u_{name[-1]}_ref_v": 400.0 * value for name, value in modulating.items()}
    switches = dict.fromkeys(SWITCHES, 0.0)
    # 800 V by the paper's gain and m of 0.6 + 0.2j, as the amplitude of a phase and its angle.
    size = math.sqrt(2 / 3) * 2 / 3 * 800.0 * math.hypot(0.6, 0.2)
    frame = {"u_d_ref_v": size, "u_q_ref_v": 0.0, "angle_rad": math.atan2(0.2, 0.6)}
    assert by_name(COMMANDS, x) == pytest.approx({**modulating, **volts, **switches, **frame})
    assert tuple(in_python(phases_at)(x, COMMANDED_M)) == pytest.approx(tuple(modulating.values()))
    assert tuple(in_python(phases_at)(x, COMMANDED_U)) == pytest.approx(tuple(volts.values()))


def test_what_is_told_of_a_run_has_a_place_each():
    """No two numbers share one."""
    assert sorted((LATEST_CALL, TRIP_SEEN, IGNORED_AT, IGNORED_STATUS)) == list(range(PROGRESSES))


@given(st.floats(-500, 500), st.floats(-500, 500), st.floats(-20, 20))
def test_voltages_in_a_frame_are_those_of_the_phases(in_python, u_d, u_q, angle):
    """Phase x has u_d cos(angle - x) - u_q sin(angle - x), x a third of a turn from phase to phase."""
    x = np.zeros(len(COMMANDS))
    x[COMMANDS.index("u_d_ref_v")], x[COMMANDS.index("u_q_ref_v")], x[COMMANDS.index("angle_rad")] = u_d, u_q, angle
    in_python(put_phases)(x, COMMANDED_U, in_python(out_of_the_frame)(x), 0.0)
    behind = [k * 2 * math.pi / 3 for k in range(3)]
    expected = [u_d * math.cos(angle - b) - u_q * math.sin(angle - b) for b in behind]
    assert tuple(in_python(phases_at)(x, COMMANDED_U)) == pytest.approx(expected, abs=1e-9)
