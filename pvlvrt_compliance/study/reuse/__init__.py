"""Records of earlier runs in place of simulations, where everything that decides a record is what it was then."""
