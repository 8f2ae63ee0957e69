"""Results for people and programs: one file a format, and what figures show."""
