"""The commands and their options, from the command line itself: docs/commands/."""
