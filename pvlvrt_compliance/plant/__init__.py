"""The power subsystem of the paper, one block a file."""
