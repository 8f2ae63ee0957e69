"""The report as sheets of paper: what stands on them as plain blocks, laid out by the templates in ``reports/pdf/``."""
