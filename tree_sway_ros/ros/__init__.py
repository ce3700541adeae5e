"""
Arrays to messages and back, parameters, timing, reports.

What nodes share, in one room per concern.
Nothing here solves anything.

"""
