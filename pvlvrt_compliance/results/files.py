"""Names of the files of a run, in its output folder."""

FOLDER = "pvlvrt-report"
"""The output folder of whoever names none."""

BASELINE = "pvlvrt-baseline.txt"
"""The file of known failures of whoever names none, beside that folder."""

INTERRUPTED = "interrupted"
"""Folder of what a run that was ended early has finished, in the output folder."""

WAVEFORMS = "waveforms"
"""Folder of the records, by the names that results refer to them by."""

RESULTS, JUNIT, REPORT, REPORT_PDF = "results.json", "junit.xml", "report.html", "report.pdf"

COMPARISON, COMPARISON_PAGE, COMPARISON_TEXT = "comparison.json", "comparison.html", "comparison.md"
COMPARISON_FILES = (COMPARISON_PAGE, COMPARISON_TEXT, JUNIT, COMPARISON)
"""Of a comparison, in a folder of its own; its JSON comes last, so that where it is, everything is."""

OLD, NEW = "old", "new"
"""Folders of the runs that a comparison has made itself."""
REPORT_MARKDOWN, BADGE, VERDICTS_CSV = "report.md", "badge.svg", "verdicts.csv"
SUMMARY_GITHUB, QUALITY_GITLAB = "github-summary.md", "gl-code-quality-report.json"

SHARD = "shard.zip"
"""What a part of a run needs to be merged with the others, besides its results and records."""

ON_REQUEST = (SHARD, REPORT_PDF, REPORT_MARKDOWN, BADGE, VERDICTS_CSV, SUMMARY_GITHUB, QUALITY_GITLAB)
"""Those that only some runs write."""
