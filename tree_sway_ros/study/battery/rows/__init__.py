"""
Rows T1 to T18 of the battery, the smallest case of each failure.

Each gives rows with a figure, a bound and whether it holds.
A known failure is reproduced, not left out.

"""
