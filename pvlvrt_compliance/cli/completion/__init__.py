"""Completion in a shell: what may be typed next, and the script that has a shell ask for it."""
