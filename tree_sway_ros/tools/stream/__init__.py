"""
Watching a stream from outside: what arrives, its figures, its words.

Nothing here grows with the length of a stream.

"""
