"""
Trees to files: YAML, OBJ, glTF.

One function per format.
Pictures are made in ``view``.

"""
