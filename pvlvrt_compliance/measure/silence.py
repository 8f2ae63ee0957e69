"""What numpy says of the numbers of a record by others: nothing."""

import numpy as np

SILENT = np.errstate(over="ignore", divide="ignore", invalid="ignore")
"""Decorator of what measures and judges. What is not finite is told where a verdict needs it (`evidence.required`), by
its instant; a warning of one line of the source tells nobody what is wrong with which channel."""
