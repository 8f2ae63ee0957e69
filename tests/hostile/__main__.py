"""Run any number of cases by hand: ``python -m tests.hostile --cases 100000 --seed 7``.

With ``--kills``, ``--full`` or ``--evil`` also the sweeps, and cases only where ``--cases`` asks for them.
"""

import argparse
import shlex
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from tests.hostile.driver import ROOT, Outcome, outcomes

_EVERY = 250
_LENGTH_S = 3.0  # about as long as a run of the sweep takes


def main(words: Sequence[str]) -> int:
    """Run what is asked for; 1 when something did not hold."""
    parser = argparse.ArgumentParser(prog="python -m tests.hostile", description=__doc__)
    parser.add_argument("--cases", type=int, help="how many (default 2000, or none beside a sweep)")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--seed", type=int, default=0, help="others with every seed (default 0)")
    parser.add_argument("--only", type=int, metavar="CASE", help="one case again, by its number")
    parser.add_argument("--keep", type=Path, help="where files of what fails are kept (default: hostile-SEED here)")
    parser.add_argument("--kills", type=int, default=0, help="runs that a signal ends at some moment")
    parser.add_argument("--full", type=int, default=0, help="runs whose files cannot become larger than some size")
    parser.add_argument("--evil", metavar="PATTERN", help="controllers that do harm, by name: '*', '*, fmu'")
    given = parser.parse_args(words)
    is_sweep = bool(given.kills or given.full or given.evil)
    cases = given.cases if given.cases is not None else 0 if is_sweep else 2000
    numbers = [given.only] if given.only is not None else range(given.first, given.first + cases)
    keep = (given.keep or Path(f"hostile-{given.seed}")).absolute()
    place = Path(tempfile.mkdtemp(prefix="hostile-"))
    # As pytest has them (pyproject.toml).
    sys.path += [str(ROOT / "tests" / name) for name in ("support", "controllers")]
    try:
        failed = _cases(given.seed, numbers, place / "cases", keep) if numbers else 0
        if given.kills or given.full:
            failed += _told(_moments(given.seed, given.kills, given.full, place / "sweep"))
        if given.evil:
            failed += _told(_evil(given.evil, place / "evil"))
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return 1 if failed else 0


def _cases(seed: int, numbers: Sequence[int], place: Path, keep: Path) -> int:
    statuses: Counter[tuple[str, int]] = Counter()
    failed = reached = peak = 0
    for done, outcome in enumerate(outcomes(seed, numbers, place, keep), start=1):
        statuses[outcome.kind, outcome.status] += 1
        reached += outcome.reached
        peak = max(peak, outcome.peak)
        if outcome.wrong:
            failed += 1
            _say(described(outcome, seed, keep))
        if done % _EVERY == 0:
            _say(f"{done} of {len(numbers)} cases, {failed} failed, {reached} to the reports")
    for kind in sorted({kind for kind, _ in statuses}):
        _say(f"{kind}: " + ", ".join(f"{n} with {s}" for (k, s), n in sorted(statuses.items()) if k == kind))
    _say(f"{len(numbers)} cases, {reached} to the reports, {failed} failed; most memory {peak / 2**20:.0f} MiB")
    return failed


def described(outcome: Outcome, seed: int, keep: Path) -> str:
    """A case that failed, in a form in which it can be run again."""
    words = _visible(" ".join(shlex.quote(word[:200]) for word in outcome.arguments))
    head = f"{outcome.kind} python -m tests.hostile --seed {seed} --only {outcome.number}: status {outcome.status}"
    files = f"    files: {keep / f'{seed}-{outcome.number}'}"
    return "\n".join([head, files, f"    {words[:500]}", *(f"    {_visible(said)}" for said in outcome.wrong)])


def _visible(text: str) -> str:
    return "".join(x if x.isprintable() else x.encode("unicode_escape").decode() for x in text)


def _moments(seed: int, kills: int, full: int, place: Path) -> Iterator[list[str]]:
    from tests.hostile.sweeps import Sweep, moments

    sweep = Sweep(place)
    return (sweep.wrong(moment) for moment in moments(seed, kills, full, _LENGTH_S))


def _evil(pattern: str, place: Path) -> Iterator[list[str]]:
    from tests.hostile.evil_more import ALL
    from tests.hostile.evil_sweep import EvilSweep

    sweep = EvilSweep(place)
    return (sweep.wrong(name, evil) for name, evil in ALL.items() if fnmatchcase(name, pattern))


def _told(found: Iterator[list[str]]) -> int:
    """Tell what a sweep finds; how often something did not hold."""
    failed = done = 0
    for done, wrong in enumerate(found, start=1):  # noqa: B007 - told below
        failed += bool(wrong)
        for said in wrong:
            _say(_visible(said))
    _say(f"{done} runs of the sweep, {failed} failed")
    return failed


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
