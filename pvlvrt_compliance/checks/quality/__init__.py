"""Checks of quality, one class a file, mirroring `profile/requirements/quality.py`."""
