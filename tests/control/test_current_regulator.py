import cmath
import math

import pytest

from pvlvrt_compliance.control.current_regulator import (
    CurrentRegulatorParams,
    at_rest_regulator,
    current_regulator_step,
)
from pvlvrt_compliance.sogi import harmonic_turns, in_steady_state

W = 2 * math.pi * 50


@pytest.fixture(scope="module")
def settled_gain(in_python, params):
    """Modulating signal over a unit error that turns at a signed harmonic order, after a long time (1/A)."""
    turns = in_python(harmonic_turns)(W * params.T)

    def gain(order: int, p: CurrentRegulatorParams) -> complex:
        # A wide resonator settles within the test; its gain at resonance does not depend on the width.
        x, m, e = at_rest_regulator(), 0j, 1 + 0j
        for k in range(2500):
            e = cmath.exp(1j * order * W * params.T * k)
            x, m = in_python(current_regulator_step)(x, e, W, turns, p._replace(w_c=100.0))
        return m / e

    return gain


def test_gain_at_resonance(settled_gain, params):
    """At the fundamental the PR gives K_P + K_I, the resonant part two samples ahead of the error."""
    alone = params.current._replace(K_I5=0.0, K_I7=0.0, K_I11=0.0, K_I13=0.0)
    K_P, K_I, lead = params.current.K_P, params.current.K_I, params.current.lead
    assert settled_gain(1, alone) == pytest.approx(K_P + K_I * cmath.exp(1j * lead * W * params.T), rel=1e-3)


@pytest.mark.parametrize("order", [-5, 7, -11, 13, -1])
def test_every_harmonic_has_its_compensator_in_both_sequences(settled_gain, params, order):
    """Resonators act on positive and negative sequence alike, with a gain far above the proportional one."""
    assert abs(settled_gain(order, params.current)) == pytest.approx(0.1, rel=0.1)


@pytest.mark.parametrize("frequency_hz", [45, 60, 65])
def test_the_resonators_follow_the_estimated_frequency(in_python, params, frequency_hz):
    """Left alone at another frequency a resonator turns with that frequency."""
    w = 2 * math.pi * frequency_hz
    turns = in_python(harmonic_turns)(w * params.T)
    p = params.current._replace(w_c=1e-6)
    x = at_rest_regulator()._replace(h1=in_steady_state(2 + 1j), h7=in_steady_state(1j))
    after, _ = in_python(current_regulator_step)(x, 0j, w, turns, p)
    assert after.h1.u / x.h1.u == pytest.approx(cmath.exp(1j * w * params.T))
    assert after.h7.u / x.h7.u == pytest.approx(cmath.exp(7j * w * params.T))
