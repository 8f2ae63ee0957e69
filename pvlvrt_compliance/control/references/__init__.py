"""The five power strategies of section 2.2: what current to ask for, one strategy a file.

All take the sequences u+ and u- of the grid voltage (V), P* (W) and Q* (var), and give the current vector (A). Power is
u conj(i) = P + jQ with u = u+ + u-. They divide by at least |u+| - |u-|, which whoever calls them keeps off zero.
"""
