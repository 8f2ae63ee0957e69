"""Wrong controllers and plants that the checks must tell from the right one: docs/mutations.md."""
