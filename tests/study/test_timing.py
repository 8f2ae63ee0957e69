"""How long something took."""

from pvlvrt_compliance.study.timing import FIXED_TIME, Stopwatch


def test_a_stopwatch_runs(monkeypatch):
    """It gives the time since it was made, in whole milliseconds, as often as it is read."""
    monkeypatch.delenv(FIXED_TIME, raising=False)
    clock = iter([100.0, 100.0124, 103.5])
    monkeypatch.setattr("pvlvrt_compliance.study.timing.perf_counter", lambda: next(clock))
    watch = Stopwatch()
    assert [watch.elapsed_s, watch.elapsed_s] == [0.012, 3.5]


def test_fixed_time_stands_still(monkeypatch):
    """Where the time of a run is fixed nothing takes any."""
    watch = Stopwatch()
    monkeypatch.setenv(FIXED_TIME, "0")
    assert watch.elapsed_s == 0.0
