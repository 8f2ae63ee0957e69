"""The pages of docs/ as a site, and whether it holds together."""
