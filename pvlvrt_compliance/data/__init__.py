"""What every file that people write shares: reading, include and merge, marked numbers, and problems in words."""
