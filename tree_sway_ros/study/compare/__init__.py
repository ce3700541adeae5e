"""
Our simulator against MuJoCo, in one run.

The same tree, wind and damping on both sides.
MuJoCo is an optional dependency.

"""
