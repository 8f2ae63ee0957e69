"""Joins plant, hardware and a controller, the bundled one or another by its door, at their two rates."""
