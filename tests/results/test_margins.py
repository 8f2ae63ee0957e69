"""Margins of different checks against each other."""

import pytest

from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude


def verdict(status=Status.PASS, **fields):
    """A verdict on some check."""
    return Verdict(check="x", status=status, **fields)


@pytest.mark.parametrize(
    ("fields", "relative"),
    [
        ({"limit": 50.0, "margin": 5.0}, 0.1),
        ({"limit": -50.0, "margin": 5.0}, 0.1),
        ({"limit": 40.0, "tolerance": 10.0, "margin": -5.0}, -0.1),
        ({"limit": 0.0, "tolerance": 10.0, "margin": 9.0}, 0.9),
        ({"limit": 0.0, "margin": 9.0}, None),
        ({"margin": 9.0}, None),
        ({"limit": 50.0}, None),
        ({"tolerance": 2.0, "margin": 1.0}, 0.5),
    ],
)
def test_a_margin_as_a_share_of_its_limit(fields, relative):
    """Of the limit with its tolerance, whatever its sign; where there is nothing to divide by, none."""
    assert verdict(**fields).relative_margin == (None if relative is None else pytest.approx(relative))


def test_a_share_is_no_part_of_the_file():
    """Keys of results.json are what they were."""
    assert "relative_margin" not in verdict(limit=1.0, margin=1.0).model_dump()


def results(*tests):
    """Results of tests, each given by its verdicts."""
    return conclude(TestResult(id=str(k), status=Status.PASS, checks=checks) for k, checks in enumerate(tests))


def test_verdicts_come_with_their_tests():
    """In the order of the tests, and in a test in that of its checks."""
    first, second, third = (verdict(limit=1.0, margin=m) for m in (0.1, 0.2, 0.3))
    assert [(f.test.id, f.verdict) for f in results((first, second), (third,)).verdicts()] == [
        ("0", first),
        ("0", second),
        ("1", third),
    ]


def test_the_worst_margin_is_the_least_share():
    """Kilowatts and seconds compare by their limits; of a failed check the margin is below zero."""
    tight, wide = verdict(limit=100.0, margin=5.0), verdict(limit=0.1, margin=0.05)
    assert results((wide,), (tight,)).worst_margin() == results((wide,), (tight,)).verdicts()[1]
    failed = verdict(Status.FAIL, limit=1.0, margin=-0.01)
    found = results((wide, tight), (failed,)).worst_margin()
    assert (found.test.id, found.verdict) == ("1", failed)


def test_the_worst_margins_come_worst_first():
    """As many as are asked for, or as there are; the first is the worst one."""
    margins = (0.3, 0.1, 0.2)
    found = results(*[(verdict(limit=1.0, margin=m),) for m in margins])
    assert [each.verdict.margin for each in found.worst_margins(2)] == [0.1, 0.2]
    assert [each.verdict.margin for each in found.worst_margins(9)] == sorted(margins)
    assert found.worst_margins(1) == (found.worst_margin(),)


def test_what_was_not_judged_has_no_margin():
    """A verdict that neither passed nor failed, or has no margin, is none of the worst."""
    unjudged = verdict(Status.NOT_EVALUATED, limit=1.0, margin=-5.0)
    assert results((unjudged, verdict())).worst_margin() is None
    assert results().worst_margin() is None
