"""
A 3D beam frame of a tree: the independent check of frequencies and statics.

Euler-Bernoulli elements with weight and twist.
Nothing that runs uses it.

"""
