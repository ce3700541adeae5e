# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a file is that none of our readers takes, by its suffix, and what to give instead."""

from __future__ import annotations

from pathlib import Path

_FOREIGN = {
    '.obj .stl .ply .fbx .glb .gltf .usd .usda .usdc .usdz .blend .dae .3ds .x3d': (
        'a mesh for drawing, without branches and diameters',
        'give the file that it was made from',
    ),
    '.las .laz .pcd .e57 .pts .ptx .copc': (
        'a point cloud',
        'fit cylinders to it first, such as by TreeQSM (doc/scans.md)',
    ),
    '.xml .sdf .urdf': ('a model for a robot simulator', 'give the file that it was made from'),
    '.html .htm': ('a page', 'give the file that it was made from'),
    '.png .jpg .jpeg .gif .mp4 .webm .tif .tiff': ('a picture or a film', ''),
    '.pdf .doc .docx .odt': ('a document', 'copy its table into a CSV file'),
    '.xls .ods .numbers': ('a spreadsheet', 'save it as .xlsx or CSV'),
    '.shp .dbf .shx .kml .kmz': ('a layer of a map', 'export it as GeoJSON, GeoPackage or CSV'),
    '.zip .gz .tgz .7z .rar .bz2 .xz': ('a compressed file', 'unpack it first'),
}  # fmt: skip


def foreign_file(path: Path) -> tuple[str, str]:
    """Return what a file is and the cure; two empty texts if its suffix does not tell."""
    suffix = path.suffix.lower()
    for suffixes, told in _FOREIGN.items():
        if suffix in suffixes.split():
            return told
    return '', ''
