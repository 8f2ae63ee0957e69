"""Checks of connection, one class a file, mirroring `profile/requirements/connection.py`."""
