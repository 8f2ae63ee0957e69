"""Tests run on the workers of a dask scheduler: the same job on many machines.

The main process keeps account of who has what: a worker gets the job once (`luggage`), after it has shown that it is
made as this process is (`identity`), and then the numbers of units, so many that it never waits (`dispatch`).
"""
