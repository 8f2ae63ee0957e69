"""Running tests: one, or a whole catalogue."""
