"""Checks: a requirement of a profile meets evidence and gives a verdict. Nothing here knows simulator or scenario."""
