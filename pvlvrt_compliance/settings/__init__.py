"""What somebody has written down once instead of typing it: a file of settings, variables of the environment."""

FILE = "pvlvrt.toml"
"""Name of a file of settings."""

PROJECT_FILE = "pyproject.toml"
"""Name of a file that may have a table of them."""
