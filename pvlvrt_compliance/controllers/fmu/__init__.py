"""Controllers that are an FMU of FMI 2.0 or 3.0."""
