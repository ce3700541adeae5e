"""Seeded generators of plausible trees: pot plants of the paper, broadleaves and conifers."""
