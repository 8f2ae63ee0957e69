"""Ports of controllers that are none."""

from pvlvrt_compliance.controllers.mapping.names import Hints, key_of
from pvlvrt_compliance.controllers.mapping.ties import RawPort
from pvlvrt_compliance.simulation.door.ports import REAL64


def port(name, unit="", width=1, byte=0, kind=REAL64, description=""):
    """A port."""
    return RawPort(name, unit, width, byte, kind, description)


def hints(unit="", description="", beside=""):
    """What there is to go by besides the name; ``beside`` are the names of all ports of the side."""
    return Hints(unit, description, frozenset(filter(None, map(key_of, beside.split()))))
