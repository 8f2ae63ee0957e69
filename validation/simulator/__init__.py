"""The simulator beside other programs, closed forms and the paper: docs/validation.md."""
