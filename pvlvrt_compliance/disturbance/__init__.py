"""What the grid did in a record: made from a scenario (`asked`) or from the record itself (`found`)."""
