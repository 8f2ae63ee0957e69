"""Controllers that are a class in Python."""
