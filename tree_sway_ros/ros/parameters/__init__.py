"""
Parameters of nodes: one table each, from which declaration, checks and documents come.

A refused value keeps the old one.
What a parameter does is written where it is used.

"""
