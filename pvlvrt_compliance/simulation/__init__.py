"""Joins plant and controller at their two rates."""
