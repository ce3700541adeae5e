"""
Methods on angles: one step per file.

The constraint is eliminated.
Shared mechanics in ``minimal_form``.

"""
