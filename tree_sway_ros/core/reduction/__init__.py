"""
From branches to matrices: inertia, stiffness, weight, natural modes, branches left out.

Done once per tree, before the first step.
Nothing here runs in a step.

"""
