"""The control subsystem of the paper, one block a file."""
