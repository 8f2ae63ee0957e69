"""Search by hand for wrong controllers that a profile passes: ``search.py --draws 20000 --seed 1``.

Prints each finding as it is found, with what is broken, and at the end how many of each kind there were. Exit status 1
when there was a finding. Ctrl-C ends it with what there is so far.
"""

import argparse
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "adversary")]

from trials import drawn, outcome_of  # noqa: E402


def main() -> int:
    """Run as a command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=1000, help="how many controllers")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the draw to begin with")
    given = parser.parse_args()
    counts: Counter[str] = Counter()
    try:
        for number, trial in enumerate(drawn(given.seed, given.draws)):
            if number < given.first:
                continue
            outcome = outcome_of(trial)
            kind = "breaks a sentence" if outcome.broken else "breaks none"
            counts[f"{outcome.result.status}, {kind}"] += 1
            if number % 500 == 499:
                print(f"{number + 1} drawn", file=sys.stderr, flush=True)
            if outcome.is_let_through:
                counts["let through"] += 1
                print(f"{number}: {trial.in_words}", *outcome.broken, sep="\n    ", flush=True)
    except KeyboardInterrupt:
        print("interrupted")
    print(*(f"{count:6d} {kind}" for kind, count in counts.most_common()), sep="\n")
    return 1 if counts["let through"] else 0


if __name__ == "__main__":
    sys.exit(main())
