"""`pvlvrt-check controllers header`."""


def header() -> None:
    """Print the C header of the IEEE/CIGRE DLL interface (CIGRE TB 958), for controllers in C or C++.

    Example: pvlvrt-check controllers header > ieee_cigre.h
    """
    print(header_text(), end="")


def header_text() -> str:
    """The header."""
    from pvlvrt_compliance.simulation.doors import HEADER

    return HEADER.read_text("utf-8")
