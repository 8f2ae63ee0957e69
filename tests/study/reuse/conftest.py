"""Records that are made up, and a store to keep them in."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reused import DEFAULTS, RECORD, SCENARIO, Controller

from pvlvrt_compliance.study.reuse import store as store_module
from pvlvrt_compliance.study.reuse.key import surroundings_digest
from pvlvrt_compliance.study.reuse.record_file import Kept
from pvlvrt_compliance.study.reuse.simulator import ReusingSimulator
from pvlvrt_compliance.study.reuse.store import RecordStore
from pvlvrt_compliance.waveforms import Segment, Waveforms

ROWS = 100


@pytest.fixture(autouse=True)
def _nothing_was_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test hears what is said once a process."""
    monkeypatch.setattr(store_module, "_said", set())


@pytest.fixture
def made() -> Callable[..., Kept]:
    """Make ``made(value=0.0, rows=100) -> Kept``: two segments, one of settling, with a channel that stays the same."""

    def made(value: float = 0.0, rows: int = ROWS) -> Kept:
        x = value + np.arange(rows, dtype=np.float64)
        still = np.full(rows, -0.0)
        before = Segment(-20.0, 1e-3, {"x": -x, "still": still + 1.0})
        first = Segment(0.0, 1e-3, {"x": x, "still": still})
        return Kept(
            Waveforms((first, Segment(20.0, 0.1 / 3, {"x": 1 / (1 + x), "still": still})), (before,), 0.1 + 0.2)
        )

    return made


@pytest.fixture
def store(tmp_path: Path) -> RecordStore:
    """A store with room enough."""
    return RecordStore(tmp_path / "records", 10**9)


@pytest.fixture
def simulated(store: RecordStore) -> Callable[..., int]:
    """How many simulations a run needs: ``simulated(scenario, parameters, controller) -> 0 or 1``."""

    def simulated(scenario=SCENARIO, parameters=DEFAULTS, controller=None, during=lambda: None):
        calls = []
        surroundings_digest.cache_clear()  # another process

        def simulate(*of):
            calls.append(of)
            during()
            return RECORD

        found = ReusingSimulator(simulate, controller, store)(scenario, parameters)
        assert [x.tolist() for x in found.segments[0].channels.values()] == [[0.0, 1.0, 2.0, 3.0]]
        return len(calls)

    return simulated


@pytest.fixture
def own(tmp_path: Path) -> Controller:
    """A controller of the user's own, with a mapping that lists files."""
    (tmp_path / "lib").mkdir()
    for name in ("gains.csv", "lib/a.py", "lib/b.py"):
        (tmp_path / name).write_text("1")
    mapping = tmp_path / "ctrl.mapping.toml"
    mapping.write_text('files = ["gains.csv", "lib/*.py"]\n')
    controller = Controller()
    return replace(controller, description=replace(controller.description, mapping=str(mapping)))
