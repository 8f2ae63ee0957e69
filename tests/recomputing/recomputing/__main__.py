"""``python -m recomputing FOLDER PROFILES``: redo the verdicts of a run.

FOLDER holds `results.json` and its waveforms as CSV, PROFILES a file ``ID.json`` for each profile. Ends with 1 where
something comes out differently.
"""

import json
import sys
from pathlib import Path

from recomputing import judge
from recomputing.comparing import differences, read_csv, read_results


def main(folder: Path, profiles: Path) -> int:
    """Print each verdict, and what it should have been where it differs."""
    different = 0
    for test in read_results(folder)["tests"]:
        profile = json.loads((profiles / f"{test['profile']}.json").read_text(encoding="utf-8"))
        waveforms = read_csv((folder / test["waveforms"]).with_suffix(".csv"))
        told = {check["check"]: check for check in test["checks"]}
        for verdict in judge(test, profile, waveforms):
            found = differences(told[verdict.check], verdict)
            different += bool(found)
            sys.stdout.write(
                "\n".join([f"{test['id']} {verdict.check} {'NOT' if found else ''} as told", *found]) + "\n"
            )
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
