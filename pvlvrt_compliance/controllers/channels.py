"""Names under which a controller's own signals are recorded, beside the channels that every record has."""

from collections.abc import Collection

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.simulation.columns import RECORDED

TAKEN = frozenset({*RECORDED, "t_s"})
"""Channels of every record."""


def check_channel(name: object, others: Collection[str] = (), *, ascii_only: bool = False) -> None:
    """Refuse what is no name for a channel, or another's.

    Raises
    ------
    DoorError
        With the name.
    """
    if not (isinstance(name, str) and name.isidentifier() and (name.isascii() or not ascii_only)):
        raise DoorError(f"{name!r} is not a name for a channel; write letters, digits and _")
    if name in TAKEN or name in others:
        raise DoorError(f"the record has a channel {name!r} already")
