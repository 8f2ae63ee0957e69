"""Every result of sections 5 and 6 of the paper."""


def test_expected_value(case, expected, measured):
    """The simulator gives what the paper, its equations or the grid's closed forms say."""
    found = measured(case, expected)
    assert abs(found - expected["value"]) <= expected["tolerance"], f"{case}: {found} for {expected}"
