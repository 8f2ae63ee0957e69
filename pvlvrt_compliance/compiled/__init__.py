"""What compiled code is made from, and where it is kept from one process to the next."""
