"""Hostile input: seeded damage of every file, option and parameter, and what must hold whatever is given.

``python -m tests.hostile --cases 100000 --seed 7`` runs any number of cases, ``--only CASE`` one of them again; the
tests beside this file run some of them each time. A case is made from its seed and its number alone.
"""
