"""Controllers that are a shared library, by the IEEE/CIGRE DLL interface."""

from pathlib import Path

HEADER = Path(__file__).with_name("ieee_cigre.h")
"""The C header of the IEEE/CIGRE DLL interface, as users compile against it."""
