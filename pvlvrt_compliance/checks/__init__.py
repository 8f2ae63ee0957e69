"""Checks: a requirement of a profile meets measurements and gives a verdict. Nothing here knows the simulator."""
