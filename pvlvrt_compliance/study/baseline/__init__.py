"""The file of known failures that a team commits: what it says, how it is written, applied and brought up to date."""
