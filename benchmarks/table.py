"""Measures everything, prints the table, and writes it as JSON and as the page of the documentation.

Each row is measured with its reference in the same run. Nothing else should run on the machine meanwhile.
"""

import argparse
import importlib
import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

from row import Row, shown

_FOLDER = Path(__file__).resolve().parent


_PAGE = """# Speed

Measured on {date}: {machine}.

{table}

Medians. A ratio is that of each run to the reference run in turn with it, so that a machine whose clock wanders, or
that others use, moves it little. `python benchmarks/table.py --json FILE --page docs/speed.md` measures it and writes
this page; nothing of it is a test. What makes runs quicker: [several cores and machines](jobs.md),
[records that are reused](reuse.md), [settling once](settle-once.md).
"""


class Part(NamedTuple):
    """Some rows: what gives them, and how many runs they are the median of."""

    module: str
    function: str
    runs: tuple[int, ...]
    in_words: str


PARTS = {
    "start-up": Part("start_up", "rows", (9, 3), "the main command, helps and lists, peak memory"),
    "judging": Part("judging", "rows", (5,), "judging against simulating"),
    "all": Part("whole_run", "rows_of_all", (1,), "every profile, minutes"),
    "jobs": Part("whole_run", "rows_of_jobs", (3,), "two worker processes against one core, minutes"),
    "kernel": Part("speed", "rows", (20,), "the compiled loop against a C twin"),
}


def measured(names: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Rows as JSON, each part in a process of its own: a child's peak memory is at least its parent's."""
    for name in names:
        print(f"{name}: {PARTS[name].in_words} ...", file=sys.stderr, flush=True)
        command = [sys.executable, __file__, "--rows-of", name]
        ended = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        yield from json.loads(ended.stdout.splitlines()[-1])


def rows_of(name: str) -> list[Row]:
    """Measure one part, in this process."""
    part = PARTS[name]
    return list(getattr(importlib.import_module(part.module), part.function)(*part.runs))


def machine() -> dict[str, Any]:
    """What was measured on."""
    return {
        "date": time.strftime("%Y-%m-%d", time.gmtime()),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        **{name: metadata.version(name) for name in ("numpy", "numba", "llvmlite", "pvlvrt-compliance")},
    }


def _processor() -> str:
    """Its name; what the system says of it where it does not tell."""
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def as_markdown(rows: Sequence[dict[str, Any]]) -> str:
    """The table."""
    lines = ["| what | measured | goals | against, in the same run | runs |", "|---|---|---|---|---|"]
    for entry in rows:
        fields = {name: entry[name] for name in Row._fields}
        row = Row(**fields)
        value = shown(row.value, row.unit) + (f" ({row.remark})" if row.remark else "")
        against = row.reference
        if row.reference_value is not None:
            against += f": {shown(row.reference_value, row.reference_unit)}"
        lines.append(f"| {row.what} | {value} | {row.goals} | {against} | {len(row.values)} |")
    return "\n".join(lines)


def page(found: dict[str, Any]) -> str:
    """The page of the documentation."""
    on = found["machine"]
    versions = ", ".join(f"{name} {on[name]}" for name in ("numpy", "numba", "llvmlite"))
    where = f"{on['processor']}, {on['cores']} cores, {on['system']}, Python {on['python']}, {versions}"
    return _PAGE.format(date=on["date"], machine=where, table=as_markdown(found["rows"]))


def options(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=(__doc__ or "").strip(),
        epilog="example: python benchmarks/table.py --only start-up --only kernel --json speed.json",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--only", action="append", choices=PARTS, help="a part of the table; without, all of it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows, and the machine, as JSON")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the page of the documentation")
    parser.add_argument(
        "--from", dest="known", type=Path, metavar="FILE", help="measure nothing: read such a JSON file"
    )
    parser.add_argument("--rows-of", choices=PARTS, help=argparse.SUPPRESS)
    return parser.parse_args(arguments)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print; return the exit status."""
    chosen = options(arguments)
    sys.path.insert(0, str(_FOLDER))
    if chosen.rows_of:
        print(json.dumps([row.as_json() for row in rows_of(chosen.rows_of)]))
        return 0
    if chosen.known:
        found = json.loads(chosen.known.read_text("utf-8"))
    else:
        try:
            found = {"machine": machine(), "rows": list(measured(chosen.only or list(PARTS)))}
        except subprocess.CalledProcessError as error:
            print(f"{' '.join(map(str, error.cmd))} ended with status {error.returncode}", file=sys.stderr)
            return 1
    print(as_markdown(found["rows"]))
    if chosen.json:
        chosen.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    if chosen.page:
        chosen.page.write_text(page(found), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
