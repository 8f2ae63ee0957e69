"""Controllers that are a program of their own, by its pipes or a socket."""
