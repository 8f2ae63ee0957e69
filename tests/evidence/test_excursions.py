"""Stretches of a mask."""

import numpy as np
import pytest

from pvlvrt_compliance.evidence.excursions import inside_of, runs_of
from pvlvrt_compliance.measure.windows import Span


@pytest.mark.parametrize(
    ("mask", "runs"),
    [
        ("", []),
        ("...", []),
        ("###", [(0, 3)]),
        ("#..##.#", [(0, 1), (3, 5), (6, 7)]),
        (".##.", [(1, 3)]),
    ],
)
def test_runs_of_a_mask(mask, runs):
    """Each with its first sample and the one after its last."""
    assert runs_of(np.array([sign == "#" for sign in mask], dtype=np.bool_)) == runs


def test_the_end_of_an_excursion_is_not_in_it():
    """Its beginning is."""
    t_s = np.arange(6.0)
    assert inside_of([Span(1.0, 3.0), Span(4.5, 5.0)], t_s).tolist() == [False, True, True, False, False, False]
