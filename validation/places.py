"""Where pages and golden cases lie in the checkout."""

import tomllib
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.scenario.scenario import Scenario

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"


class GoldenCase(NamedTuple):
    """A folder of `tests/golden`, and its input."""

    folder: Path
    scenario: Scenario
    settings: tuple[str, ...]  # what ``--set`` takes


def golden_cases() -> list[GoldenCase]:
    """All cases that are simulated, by name."""
    return [_case(file) for file in sorted((ROOT / "tests" / "golden").glob("*/input.toml"))]


def _case(file: Path) -> GoldenCase:
    table = tomllib.loads(file.read_text("utf-8"))
    return GoldenCase(file.parent, Scenario.model_validate(table["scenario"]), tuple(table.get("parameters", ())))
