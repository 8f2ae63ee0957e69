"""Which port of a controller is which signal of the plant: a file, names, units."""
