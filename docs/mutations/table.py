"""The table: every mutant through every test of its profile, and the page that shows which checks failed."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

from mutants import MUTANTS, RIGHT, UNNOTICED, Mutant
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.results import Status, Verdict
from pvlvrt_compliance.scenario.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.rows import run_rows
from pvlvrt_compliance.study.run import run_test
from wrong_controllers import Wrong, wrong_run

PROFILE = Path(__file__).with_name("mutation-table.toml")
ROWS = (RIGHT, *MUTANTS)


class Verdicts(NamedTuple):
    """Names of the checks by what they came to in any of the tests."""

    failed: frozenset[str]
    passed: frozenset[str]
    undecided: frozenset[str]
    """Without a verdict: an error, or not evaluated."""


@cache
def table_profile() -> Profile:
    """The profile that judges."""
    return load_profile(str(PROFILE))


def kinds() -> list[str]:
    """The checks of the table, in the order of its columns."""
    return [kind for kind, _ in table_profile().requirements.by_kind()]


def simulator(wrong: Wrong | None) -> Callable[..., Any]:
    """The simulator, with a mistake in the controller or without."""
    return simulate if wrong is None else partial(simulate, run=wrong_run(wrong))


def checks_of(mutant: Mutant) -> Iterator[Verdict]:
    """Every verdict on a mutant."""
    profile, parameters = table_profile(), parameters_from(mutant.settings)
    judge = partial(run_test, profile, parameters=parameters, simulator=simulator(mutant.wrong))
    for _, judged in run_rows(profile, profile.tests(), judge):
        yield from judged.result.checks


def verdicts_on(mutant: Mutant) -> Verdicts:
    """What the checks say of a mutant, over all tests."""
    found = [(check.check, check.status) for check in checks_of(mutant)]
    named = lambda *wanted: frozenset(name for name, status in found if status in wanted)  # noqa: E731
    return Verdicts(named(Status.FAIL), named(Status.PASS), named(Status.ERROR, Status.NOT_EVALUATED))


def verdicts_on_all() -> dict[str, Verdicts]:
    """The verdicts by the name of the mutant, two of them at a time."""
    wrong_run(Wrong.NOTHING)  # one loop is built, before two threads ask for it
    with ThreadPoolExecutor(2) as pool:
        return dict(zip((row.name for row in ROWS), pool.map(verdicts_on, ROWS), strict=True))


def mark(kind: str, verdicts: Verdicts) -> str:
    """One cell: failed, passed, or nothing to judge."""
    if kind in verdicts.failed:
        return "**F**"
    return "·" if kind in verdicts.passed else ""


def how(mutant: Mutant) -> str:
    """How to see it."""
    if mutant.wrong is not None:
        return f"`Wrong.{mutant.wrong.name}`"
    return "<br>".join(f"`--set {setting}`" for setting in mutant.settings)


_HEAD = """# Mutations

Do the checks tell a wrong controller from the right one? Below, {count} controllers and plants with one mistake each
go through every test of [`mutation-table.toml`](mutations/mutation-table.toml), a profile that has every kind of
requirement and that the paper's control meets (first row). **F**: the check failed in at least one test; a dot: it
passed wherever it had something to judge; empty: it had nothing to judge, or the inverter had stopped. Which checks
must fail is stated in [`mutants.py`](mutations/mutants.py) with the reason, and `tests/study/test_mutations.py`
demands exactly these. The page is written by `python docs/mutations/generate.py`; `--check` runs everything anew and
compares.
"""

_REASONS = """## Why

Settings are shown as the command line takes them, for instance
`pvlvrt-check --profile docs/mutations/mutation-table.toml --set controller.fll_gain=0`. The others are branches of one
compiled controller, [`wrong_controllers.py`](mutations/wrong_controllers.py).
"""

_UNNOTICED = """## What no check notices

The last {count} rows are mistakes that leave every requirement met: a test of compliance is no test of quality.
"""


def page(found: dict[str, Verdicts]) -> str:
    """The whole page."""
    return "\n".join(
        [
            _HEAD.format(count=len(MUTANTS)),
            *_table(found),
            "",
            _REASONS,
            "| mutant | what is wrong, and what fails for it | how to see it |",
            "|---|---|---|",
            *(f"| {mutant.name} | {mutant.why} | {how(mutant)} |" for mutant in MUTANTS),
            "",
            _UNNOTICED.format(count=len(UNNOTICED)),
        ]
    )


def _table(found: dict[str, Verdicts]) -> Iterator[str]:
    columns = kinds()
    yield f"| | {' | '.join(kind.replace('_', ' ') for kind in columns)} |"
    yield f"|---|{'---|' * len(columns)}"
    for row in ROWS:
        yield f"| {row.name} | {' | '.join(mark(kind, found[row.name]) for kind in columns)} |"
