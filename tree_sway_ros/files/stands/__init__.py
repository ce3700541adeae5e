"""
Stands as a forester has them: a table of places, species and heights.

"""
