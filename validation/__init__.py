"""Evidence: what other programs, closed forms and wrong controllers say of the simulator and of the checks.

Each folder writes one page of `docs/`: ``python -m validation.simulator``, ``.mutations``, ``.grid_codes``,
``.fidelity``, ``.paper``, and ``.blocks`` those of the blocks, from the checkout. With ``--check`` it compares and
writes nothing.
"""
