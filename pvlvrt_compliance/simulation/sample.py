"""One sample: what there is as the controller looks."""

from typing import NamedTuple

from pvlvrt_compliance.hardware.hardware import Hardware, seen_at
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant.plant import Observed, PlantState


class Sample(NamedTuple):
    """What there is at the instant of a sample."""

    k: int  # samples before it in this run
    t: float  # (s)
    seen: Measured
    u_zero: float  # zero-sequence voltage (V)
    m: complex  # modulating signal that acts (-)
    G: float  # irradiance, in units of 1000 W/m2 (-)


@kernel
def sampled(x: PlantState, y: Observed, m: complex, G: float, t: float, k: int, hardware: Hardware | None) -> Sample:
    """Sample of the plant, as the sensors have it."""
    measured = Measured(u_g_ab=y.u_ab, i_ab=x.i, v_dc=x.v_dc, i_pv=x.i_pv)
    return Sample(k=k, t=t, seen=seen_at(measured, y.u_zero, k, hardware), u_zero=y.u_zero, m=m, G=G)
