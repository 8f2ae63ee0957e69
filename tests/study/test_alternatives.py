"""What the shipped profile says of each alternative in the three sags of the paper."""

import pytest

from pvlvrt_compliance.results import Status

SAGS = ("three-phase 90 %", "phase c 90 %", "phase c 50 %")
# Oscillating active power reaches the DC link, which the paper's own strategy is there to protect.
SWINGING = {"constant-q", "balanced"}

both_frequencies = pytest.mark.parametrize("frequency_hz", [50.0, 60.0])
every_sag = pytest.mark.parametrize("sag", SAGS)


def failed(result):
    """Names of the checks that are not passed."""
    return {check.check for check in result.checks if check.status is not Status.PASS}


@both_frequencies
@every_sag
@pytest.mark.parametrize("algorithm", ["dsogi-fll", "srf-pll", "ddsrf-pll", "dsc-pll"])
def test_every_synchronisation_passes(judge, algorithm, sag, frequency_hz):
    """On a clean grid each of them rides through the sags of the paper and passes every check."""
    assignments = [f"controller.synchronisation={algorithm}"]
    assert failed(judge(sag, assignments=assignments, frequency_hz=frequency_hz)) == set()


@both_frequencies
@every_sag
@pytest.mark.parametrize("strategy", ["constant-p-q", "constant-p-light-q", "constant-q", "balanced"])
def test_power_strategies(judge, strategy, sag, frequency_hz):
    """Strategies that let P oscillate fail the ripple of the DC voltage in unbalanced sags, and nothing else."""
    expected = {"dc_ripple"} if strategy in SWINGING and sag.startswith("phase") else set()
    assignments = [f"controller.power_strategy={strategy}"]
    assert failed(judge(sag, assignments=assignments, frequency_hz=frequency_hz)) == expected
