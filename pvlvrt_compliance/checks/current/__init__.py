"""Checks of current, one class a file, mirroring `profile/requirements/current.py`."""
