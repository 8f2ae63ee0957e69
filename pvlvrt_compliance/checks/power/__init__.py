"""Checks of power, one class a file, mirroring `profile/requirements/power.py`."""
