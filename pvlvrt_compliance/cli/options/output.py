"""What is written, shown and told by the status."""

from pvlvrt_compliance.cli.options.option import Option, flag, text, texts
from pvlvrt_compliance.report.formats import names

_PANEL = "Output"

OPTIONS: dict[str, Option] = {
    "output": text("--output", "FOLDER", "Where reports go. Default pvlvrt-report.", _PANEL),
    "csv": flag("--csv", help="Write waveforms as CSV, too.", panel=_PANEL),
    "waveforms": text("--waveforms", "WHICH", "Waveforms kept: all (default), failed or none.", _PANEL, "waveforms"),
    "formats": texts(
        "--format",
        "NAME",
        f"A report, repeatable: {', '.join(names())}. Written in any case: html, json, junit; pdf needs the extra pdf.",
        _PANEL,
        "formats",
    ),
    "language": text("--language", "en|es", "Language of the reports. Default en.", _PANEL, "languages"),
    "report_fields": texts(
        "--report-field",
        "NAME=VALUE",
        "Of the title page, repeatable: --report-field client='Solar Ltd'. Names: client, object,"
        " manufacturer, type, serial, firmware, commit, number, revision, author, approval, logo, remark.",
        _PANEL,
        "report_fields",
    ),
    "baseline": text("--baseline", "FILE", "Known failures: 0 then says that nothing is worse than the file.", _PANEL),
    "baseline_tolerance": text(
        "--baseline-tolerance", "SHARE", "Of the limit, that a margin may lose against it. Default 1%.", _PANEL
    ),
    "allow_unjudged": flag(
        "--allow-unjudged",
        help="What could not be judged no longer makes the exit status 3, and is skipped in junit.xml. Example:"
        " --profile all --sag 50% --allow-unjudged",
        panel=_PANEL,
    ),
    "exit_zero": flag("--exit-zero", help="End with 0 whatever the verdicts.", panel=_PANEL),
    "verbose": flag("--verbose", "-v", help="Name everything that is not verified, with its source.", panel=_PANEL),
    "quiet": flag("--quiet", "-q", help="Print one line of summary.", panel=_PANEL),
}
