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
    """State of the chosen algorithm; the others are none. numba compiles the one that is there, and nothing else."""

    msogi: MsogiFllState | None
    dsogi: DsogiFllState | None
    srf: SrfPllState | None
    ddsrf: DdsrfPllState | None
    dsc: DscPllState | None


def locked(u_pos: complex, w: float, p: SynchronisationParams, T: float) -> SynchronisationState:
    """State locked to a balanced, clean grid at this angular frequency (rad/s), ``u_pos`` (V) in the next sample."""
    chosen = p.algorithm
    return SynchronisationState(
        msogi=msogi_fll.locked(u_pos, w) if chosen == MSOGI_FLL else None,
        dsogi=dsogi_fll.locked(u_pos, w) if chosen == DSOGI_FLL else None,
        srf=srf_pll.locked(u_pos, w, p.srf) if chosen == SRF_PLL else None,
        ddsrf=ddsrf_pll.locked(u_pos, w) if chosen == DDSRF_PLL else None,
        dsc=dsc_pll.locked(u_pos, w, p.dsc.w_min, T) if chosen == DSC_PLL else None,
    )


def with_arrays_of(before: SynchronisationState, x: SynchronisationState) -> SynchronisationState:
    """The same with the arrays of the state that the run began with, as they are after it."""
    if before.dsc is None or x.dsc is None:
        return x
    return x._replace(dsc=x.dsc._replace(line=before.dsc.line))


@kernel
def advance_chosen(
    msogi: MsogiFllState | None,
    dsogi: DsogiFllState | None,
    srf: SrfPllState | None,
    ddsrf: DdsrfPllState | None,
    dsc: DscPllState | None,
    u_g_ab: complex,
    p: SynchronisationParams,
    T: float,
) -> tuple[SynchronisationState, Synchronisation]:
    """Advance the algorithm whose state is there. States are arguments, never assigned, so that numba sees the none."""
    if msogi is not None:
        msogi_next, msogi_y = msogi_fll_step(msogi, u_g_ab, p.fll, T)
        return SynchronisationState(msogi=msogi_next, dsogi=None, srf=None, ddsrf=None, dsc=None), msogi_y
    if dsogi is not None:
        dsogi_next, dsogi_y = dsogi_fll_step(dsogi, u_g_ab, p.fll, T)
        return SynchronisationState(msogi=None, dsogi=dsogi_next, srf=None, ddsrf=None, dsc=None), dsogi_y
    if srf is not None:
        srf_next, srf_y = srf_pll_step(srf, u_g_ab, p.srf, T)
        return SynchronisationState(msogi=None, dsogi=None, srf=srf_next, ddsrf=None, dsc=None), srf_y
    if ddsrf is not None:
        ddsrf_next, ddsrf_y = ddsrf_pll_step(ddsrf, u_g_ab, p.ddsrf, T)
        return SynchronisationState(msogi=None, dsogi=None, srf=None, ddsrf=ddsrf_next, dsc=None), ddsrf_y
    if dsc is None:
        raise ValueError("no synchronisation has a state")
    dsc_next, dsc_y = dsc_pll_step(dsc, u_g_ab, p.dsc, T)
    return SynchronisationState(msogi=None, dsogi=None, srf=None, ddsrf=None, dsc=dsc_next), dsc_y


@kernel
def synchronise(
    x: SynchronisationState, u_g_ab: complex, p: SynchronisationParams, T: float
) -> tuple[SynchronisationState, Synchronisation]:
    """Advance the chosen synchronisation by one sample of the grid voltage (V)."""
    return advance_chosen(x.msogi, x.dsogi, x.srf, x.ddsrf, x.dsc, u_g_ab, p, T)
