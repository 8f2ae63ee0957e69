"""What a controller of single precision is handed."""

from pvlvrt_compliance.hardware.precision import single_measured
from pvlvrt_compliance.kernel import plain
from pvlvrt_compliance.measured import Measured

ULP = 2.0**-23  # of numbers from 1 to 2


def test_what_is_read_is_rounded():
    """Each number goes to the nearest one of 32 bits, up or down."""
    fine = 1 + 0.4 * ULP
    read = plain(single_measured)(Measured(u_g_ab=complex(fine, -fine), i_ab=1j * fine, v_dc=fine, i_pv=1 + 0.6 * ULP))
    assert read == Measured(u_g_ab=1 - 1j, i_ab=1j, v_dc=1.0, i_pv=1 + ULP)
