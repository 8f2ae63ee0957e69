"""The golden cases as figures, each beside what the paper says of it: docs/paper.md."""
