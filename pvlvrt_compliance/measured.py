"""What passes from hardware to control: one sample of everything that the controller measures."""

from typing import NamedTuple


class Measured(NamedTuple):
    """What the controller samples once a period."""

    u_g_ab: complex  # grid voltage at the PCC (V)
    i_ab: complex  # inverter current (A)
    v_dc: float  # DC-link voltage (V)
    i_pv: float  # current of the PV array (A)
