"""What every shipped profile says of the paper's controller: docs/grid-codes.md."""
