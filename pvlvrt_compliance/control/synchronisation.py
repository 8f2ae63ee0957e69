"""Chooses the synchronisation: wires the alternatives of section 1 of the paper beside its own."""

from typing import NamedTuple

from pvlvrt_compliance.control import ddsrf_pll, dsc_pll, dsogi_fll, msogi_fll, srf_pll
from pvlvrt_compliance.control.ddsrf_pll import DdsrfPllParams, DdsrfPllState, ddsrf_pll_step
from pvlvrt_compliance.control.dsc_pll import DscPllState, dsc_pll_step
from pvlvrt_compliance.control.dsogi_fll import DsogiFllState, dsogi_fll_step
from pvlvrt_compliance.control.fll import FllParams
from pvlvrt_compliance.control.msogi_fll import MsogiFllState, msogi_fll_step
from pvlvrt_compliance.control.pll import PllParams
from pvlvrt_compliance.control.srf_pll import SrfPllParams, SrfPllState, srf_pll_step
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel

MSOGI_FLL, DSOGI_FLL, SRF_PLL, DDSRF_PLL, DSC_PLL = range(5)
"""Algorithms of synchronisation."""


class SynchronisationParams(NamedTuple):
    """Algorithm, and the parameters of each."""

    algorithm: int  # one of the codes above (-)
    fll: FllParams  # of both FLLs
    srf: SrfPllParams
    ddsrf: DdsrfPllParams
    dsc: PllParams


class SynchronisationState(NamedTuple):
    """States of all algorithms; only that of the chosen one moves."""

    msogi: MsogiFllState
    dsogi: DsogiFllState
    srf: SrfPllState
    ddsrf: DdsrfPllState
    dsc: DscPllState


def locked(u_pos: complex, w: float, p: SynchronisationParams, T: float) -> SynchronisationState:
    """State locked to a balanced, clean grid at this angular frequency (rad/s), ``u_pos`` (V) in the next sample."""
    return SynchronisationState(
        msogi=msogi_fll.locked(u_pos, w),
        dsogi=dsogi_fll.locked(u_pos, w),
        srf=srf_pll.locked(u_pos, w, p.srf),
        ddsrf=ddsrf_pll.locked(u_pos, w),
        dsc=dsc_pll.locked(u_pos, w, p.dsc.w_min, T),
    )


@kernel
def synchronise(
    x: SynchronisationState, u_g_ab: complex, p: SynchronisationParams, T: float
) -> tuple[SynchronisationState, Synchronisation]:
    """Advance the chosen synchronisation by one sample of the grid voltage (V)."""
    msogi, dsogi, srf, ddsrf, dsc = x.msogi, x.dsogi, x.srf, x.ddsrf, x.dsc
    if p.algorithm == MSOGI_FLL:
        msogi, y = msogi_fll_step(msogi, u_g_ab, p.fll, T)
    elif p.algorithm == DSOGI_FLL:
        dsogi, y = dsogi_fll_step(dsogi, u_g_ab, p.fll, T)
    elif p.algorithm == SRF_PLL:
        srf, y = srf_pll_step(srf, u_g_ab, p.srf, T)
    elif p.algorithm == DDSRF_PLL:
        ddsrf, y = ddsrf_pll_step(ddsrf, u_g_ab, p.ddsrf, T)
    else:
        dsc, y = dsc_pll_step(dsc, u_g_ab, p.dsc, T)
    return SynchronisationState(msogi=msogi, dsogi=dsogi, srf=srf, ddsrf=ddsrf, dsc=dsc), y
