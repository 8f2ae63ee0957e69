"""A run that is killed, told to end, or without room on its disk leaves an old run, a new one, or no verdict."""

import os

import pytest

from tests.hostile.sweeps import Sweep, moments

LENGTH_S = 3.0
"""About as long as a run takes, from its start (s); on a busy machine more are ended early, which is right, too."""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="Windows cannot send a signal to one process")
def test_some_moments(tmp_path):
    """Whatever the moment and the size: the status says it, files are of one run, no file and no process is left."""
    sweep = Sweep(tmp_path)
    assert [said for moment in moments(1, kills=4, full=3, length_s=LENGTH_S) for said in sweep.wrong(moment)] == []
