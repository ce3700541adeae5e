"""
Pictures and films of trees with matplotlib.

Projection, bark, leaves, plots.
Nothing here is needed to solve or stream.

"""
