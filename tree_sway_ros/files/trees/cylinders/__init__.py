"""
Cylinder models of scans: TreeQSM, SimpleForest, aRchi, PyTLidar.

Readers give `Cylinders`; joining and merging make branches of them.
Skeletons without cylinders live next door.

"""
