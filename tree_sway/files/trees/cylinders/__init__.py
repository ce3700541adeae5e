# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cylinder models of scans: TreeQSM, SimpleForest, aRchi, PyTLidar.

Readers give `Cylinders`; joining and merging make branches of them. Skeletons without cylinders
are in `formats`.
"""
