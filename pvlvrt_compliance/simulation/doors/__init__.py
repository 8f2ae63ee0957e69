"""Doors for a controller of the user's own: each opens one kind of controller for the one loop."""
