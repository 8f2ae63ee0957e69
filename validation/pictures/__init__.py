"""Figures of reports that pages show: docs/index/, docs/tutorial/."""
