"""Pages of the blocks of controller, plant and hardware: what of them is computed, and their figures."""
