"""Which tests are run."""

import typer

from pvlvrt_compliance.cli.options.option import Option, flag, text, texts

_PANEL = "Selection"


def _goes_with_the_list(context: typer.Context, wanted: bool | None) -> bool | None:
    if wanted and not context.params.get("list_only"):
        raise typer.BadParameter("goes with --list only")
    return wanted


OPTIONS: dict[str, Option] = {
    "tests": texts("--test", "PATTERN", "Tests to run, by id or row, repeatable: --test 'VD3*'", _PANEL, "tests"),
    "skip": texts("--skip", "PATTERN", "Tests not to run, likewise: --skip VD1", _PANEL, "tests"),
    "checks": texts("--check", "NAME", "Judge only this check, repeatable: --check reactive_support", _PANEL, "checks"),
    "last_failed": flag(
        "--last-failed",
        help="Run only tests that the last run into --output did not pass, and their rows where a rule is on these; all"
        " where there is none.",
        panel=_PANEL,
    ),
    "failed_first": flag("--failed-first", help="Run those tests first, then the others.", panel=_PANEL),
    "fail_fast": flag("--fail-fast", "-x", help="End at the first test that is not passed.", panel=_PANEL),
    "include_long": flag("--include-long", help="Run tests of half an hour, too.", panel=_PANEL),
    "shard": text(
        "--shard", "I/N", "Run one of N parts, which pvlvrt-check merge puts together again: --shard 2/5", _PANEL
    ),
    "list_only": flag("--list", help="Show the selected tests and stop.", panel=_PANEL, more={"is_eager": True}),
    "list_json": flag(
        "--json", help="With --list: as JSON, for programs.", panel=_PANEL, more={"callback": _goes_with_the_list}
    ),
}
