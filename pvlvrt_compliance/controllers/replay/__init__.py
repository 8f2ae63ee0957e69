"""A controller that is fed what was recorded, without a plant, and what it gives beside what was expected."""
