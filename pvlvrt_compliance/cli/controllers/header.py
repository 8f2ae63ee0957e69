"""`pvlvrt-check controllers header`."""

from pvlvrt_compliance.cli.telling import hand_over


def header() -> None:
    """Print the C header of the IEEE/CIGRE DLL interface (CIGRE TB 958), for controllers in C or C++.

    Example: pvlvrt-check controllers header > ieee_cigre.h
    """
    from pvlvrt_compliance.controllers.library import HEADER

    hand_over(HEADER.read_text("utf-8"))
