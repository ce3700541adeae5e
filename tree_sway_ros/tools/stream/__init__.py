"""
The command line ``tree-sway``: one module per command.
"""
Watching a stream from outside: what arrives, its figures, its words.

Nothing here grows with the length of a stream.

"""
