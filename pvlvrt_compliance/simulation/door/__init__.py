"""The compiled side of a door: ports in shared memory, the table of them, the call."""
