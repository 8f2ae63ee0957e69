"""Ports of controllers that are none."""

from pvlvrt_compliance.controllers.mapping.ties import RawPort
from pvlvrt_compliance.simulation.door.ports import REAL64


def port(name, unit="", width=1, byte=0, kind=REAL64):
    """A port."""
    return RawPort(name, unit, width, byte, kind)
