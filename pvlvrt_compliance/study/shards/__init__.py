"""A run in parts, each by itself wherever it likes, and the parts as one run again."""
