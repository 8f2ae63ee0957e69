"""One-cycle series of simulated records, compiled: one sweep over the samples, nothing kept but the last cycle.

What is measured, and how, is defined by `measure`, whose functions these stand in for: the same but for rounding.
"""
