"""Where a controller runs: a process of its own, told apart, timed and ended; and what the command does when it ends.

The one place that knows of fork, groups of processes and signals; what a system lacks is left out there. (A file that
one process holds is `locks`.)
"""
