"""Doors for a controller of the user's own: each opens one kind of controller for the one loop."""

from pathlib import Path

HEADER = Path(__file__).with_name("ieee_cigre.h")
"""The C header of the IEEE/CIGRE DLL interface, as users compile against it."""
