"""How many examples the property tests draw, and from which seeds: the one place that says so."""

from hypothesis import HealthCheck, settings

USUAL = 100
"""Examples of a test that does not say `draws`, where nothing is searched for."""

# How long an example takes to be drawn says something about the machine, and nothing about the code.
_SPEED = HealthCheck.too_slow


def load_profile(search: int | None) -> None:
    """Say how all tests draw: the same examples in every run, or in a search this many fresh ones.

    No example is kept in a database: an example that has failed is written into its test, as an ``@example``.
    """
    common = {"database": None, "deadline": None, "suppress_health_check": [_SPEED]}
    settings.register_profile("same", max_examples=USUAL, derandomize=True, **common)
    settings.register_profile("search", max_examples=search or USUAL, derandomize=False, print_blob=True, **common)
    settings.load_profile("search" if search else "same")


def draws(count: int, *without: HealthCheck) -> settings:
    """Settings of a test that draws another number of examples than `USUAL`; a search draws as many times more.

    Health checks that it cannot pass, whatever it draws, are named besides.
    """
    in_all = max(round(count * settings.default.max_examples / USUAL), 1)
    return settings(max_examples=in_all, suppress_health_check=[_SPEED, *without])
