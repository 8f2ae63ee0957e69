"""The table: every mutant through every test of its profile, and the page that shows which checks failed."""

import hashlib
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.evaluate import errored
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.results import Status, Verdict
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.rows import run_rows
from pvlvrt_compliance.study.run import Judged, run_test
from pvlvrt_compliance.waveforms import Segment, Waveforms
from validation.mutations.mutant import Mutant
from validation.mutations.mutants import MUTANTS, RIGHT
from validation.mutations.slips import NO_SLIP
from validation.mutations.unnoticed import UNNOTICED
from validation.mutations.wrong_controllers import Wrong, wrong_run

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


def recorded(mutant: Mutant, scenario: Scenario, parameters: Parameters) -> Waveforms:
    """A record of the right controller, or of one with a mistake: every second sample, as a laboratory takes them.

    12 kHz show all that is judged, in half the time.
    """
    if mutant.wrong is None and mutant.slip is None:
        made = simulate(scenario, parameters)
    else:
        made = simulate(scenario, parameters, run=wrong_run(mutant.wrong or Wrong.NOTHING, mutant.slip or NO_SLIP))
    halved = (
        Segment(part.t0_s, 2 * part.dt_s, {name: channel[::2] for name, channel in part.channels.items()})
        for part in made
    )
    return Waveforms(tuple(halved))


def digest(waveforms: Waveforms) -> bytes:
    """What two records have in common only if every number of theirs is the same."""
    found = hashlib.blake2b()
    for segment in waveforms:
        found.update(f"{segment.t0_s!r} {segment.dt_s!r}".encode())
        for name, channel in segment.channels.items():
            found.update(name.encode())
            found.update(np.ascontiguousarray(channel).data)
    return found.digest()


@cache
def of_the_right_one() -> dict[str, tuple[bytes, Judged]]:
    """Digest and verdicts of each record of the right controller, by test."""
    parameters, make = parameters_from(RIGHT.settings), partial(recorded, RIGHT)
    runs = {test.id: run_test(table_profile(), test, parameters, make) for test in table_profile().tests()}
    return {
        name: (digest(run.waveforms), run._replace(waveforms=None, evidence=None))
        for name, run in runs.items()
        if run.waveforms
    }


def judged(mutant: Mutant, parameters: Parameters, test: TestCase) -> Judged:
    """One test; a record which is in every number the right controller's has its verdicts, without being judged."""
    try:
        waveforms = recorded(mutant, test.scenario, parameters)
    except PvlvrtError as error:
        return Judged(errored(table_profile(), test, str(error)), None)
    right = of_the_right_one().get(test.id)
    if right is not None and right[0] == digest(waveforms):
        return right[1]
    return run_test(table_profile(), test, parameters, lambda *_: waveforms)


def checks_of(mutant: Mutant) -> Iterator[Verdict]:
    """Every verdict on a mutant."""
    profile, parameters = table_profile(), parameters_from(mutant.settings)
    for _, run in run_rows(profile, profile.tests(), partial(judged, mutant, parameters)):
        yield from run.result.checks


def verdicts_on(mutant: Mutant) -> Verdicts:
    """What the checks say of a mutant, over all tests."""
    found = [(check.check, check.status) for check in checks_of(mutant)]
    undecided = _with(Status.ERROR, found) | _with(Status.NOT_EVALUATED, found)
    return Verdicts(_with(Status.FAIL, found), _with(Status.PASS, found), undecided)


def _with(wanted: str, found: Iterable[tuple[str, str]]) -> frozenset[str]:
    """Names of the checks that came to ``wanted``."""
    return frozenset(name for name, came_to in found if came_to == wanted)


def verdicts_on_all() -> dict[str, Verdicts]:
    """The verdicts by the name of the mutant, two of them at a time."""
    wrong_run(Wrong.NOTHING)  # one loop is built, and the right controller judged, before two threads ask for it
    of_the_right_one()
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
    if mutant.slip is not None:
        return f"`Slip({mutant.slip.in_words})`"
    return "<br>".join(f"`--set {setting}`" for setting in mutant.settings)


_HEAD = """# Mutations

Do the checks tell a wrong controller from the right one? Below, {count} controllers and plants with one mistake each go
through every test of `validation/mutations/mutation-table.toml`, a profile that has every
kind of requirement and that the paper's control meets (first row). Two of its tests have several stretches (two sags
and a swell; a fault whose inner level is deeper), for controllers that are right in the first sag and wrong in a later
one. **F**: the check failed in at least one test; a dot: it passed wherever it had something to judge; empty: it had
nothing to judge, or the inverter had stopped. Which checks must fail is stated in
`validation/mutations/mutants.py` and the `*_mutants.py` beside it, with the reason, before anything is
run, and `tests/study/test_mutations.py` demands exactly these. The page is written by `python -m validation.mutations`;
`--check` runs everything anew and compares.
"""

_REASONS = """## Why

Settings are shown as the command line takes them, for instance `pvlvrt-check --profile
validation/mutations/mutation-table.toml --set controller.fll_gain=0`. The others run in one compiled controller:
`Wrong` is a branch of `validation/mutations/wrong_controllers.py`, `Slip` what goes wrong,
by how much and when, in numbers of `validation/mutations/slips.py`: in which sags, from when on in them,
at which V+. A slip with `first=2` leaves the first sag right, one with `low_pu` and `high_pu` all levels but one.
"""

_UNNOTICED = """## What no check notices

The last {count} rows are mistakes that leave every requirement met; each is left open by the texts themselves.

| mutant | which text leaves it open |
|---|---|
"""

_ADVERSARY = """## A search for more

The table holds what somebody has thought of. `tests/adversary/` looks for the rest: it draws a slip (what, by how much,
in which sags, from when to when, at which voltage) and a grid (two sags, a sag within a sag, a swell after a sag; three
phases or one) for one of {codes} profiles, runs the simulator, and has the record judged twice: by the profile, and by
plain sentences about the waveform that share no code with the package (`sentences.py`: "some current flows in every
sag", "the breaker stays closed", "P and Q do not go to and fro while the grid stands still"). Between a sentence's
number and the profile's lies a gap, so that only what is clearly broken counts. A controller which a profile passes
while it breaks one of its sentences is a finding. Every run of the tests draws the same {draws}; by hand, as many as
wanted:

```sh
.venv/bin/python tests/adversary/search.py --draws 20000 --seed 1
```

The right controller goes through the same grids: it passes and breaks nothing.
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
            _UNNOTICED.format(count=len(UNNOTICED)).rstrip(),
            *(f"| {mutant.name} | {mutant.left_open} |" for mutant in UNNOTICED),
            "",
            _ADVERSARY.format(codes="seven", draws=300).rstrip(),
            "",
        ]
    )


def _table(found: dict[str, Verdicts]) -> Iterator[str]:
    columns = kinds()
    yield f"| | {' | '.join(kind.replace('_', ' ') for kind in columns)} |"
    yield f"|---|{'---|' * len(columns)}"
    for row in ROWS:
        yield line(row.name, found[row.name])


def line(name: str, verdicts: Verdicts) -> str:
    """One row of the table."""
    return f"| {name} | {' | '.join(mark(kind, verdicts) for kind in kinds())} |"


def verdicts_in(text: str) -> dict[str, Verdicts]:
    """What a page shows of each mutant."""
    shown = {}
    for name, *marks in (row.removesuffix(" |").removeprefix("| ").split(" | ") for row in text.splitlines()):
        if len(marks) == len(kinds()) and name in {row.name for row in ROWS}:
            of = list(zip(kinds(), (cell.strip() for cell in marks), strict=True))
            shown[name] = Verdicts(_with("**F**", of), _with("·", of), frozenset())
    return shown
