"""
Skeletons of nodes: MTG, SWC, RayCloudTools.

Readers give nodes with a parent and a diameter.
Cylinder models live next door.

"""
