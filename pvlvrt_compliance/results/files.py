"""Names of the files of a run, in its output folder."""

WAVEFORMS = "waveforms"
"""Folder of the records, by the names that results refer to them by."""

RESULTS, JUNIT, REPORT, REPORT_PDF = "results.json", "junit.xml", "report.html", "report.pdf"
