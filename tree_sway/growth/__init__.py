# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees grown from a species, a height and a seed, for who has no scan.

`grow` makes a plausible tree: a habit (`broadleaf`, `conifer`) with the forms of its species
(``*_forms.csv``) and the crowns of its forest (`crown_allometry`), twigs, and diameters by the
pipe model (`thickness`). `builtin_tree` gives the
paper's two pot plants and a small broadleaf by name. `stem_growth` is a stem's diameter by age,
and `grown_beyond` grows what a scan could not see. Nothing here knows of wind or files.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.growth.beyond_scan import grown_beyond as grown_beyond
    from tree_sway.growth.beyond_scan import is_cut as is_cut
    from tree_sway.growth.beyond_scan import open_diameter as open_diameter
    from tree_sway.growth.builtin import builtin_tree as builtin_tree
    from tree_sway.growth.builtin import BUILTIN_TREES as BUILTIN_TREES
    from tree_sway.growth.crown_allometry import BREAST_HEIGHT as BREAST_HEIGHT
    from tree_sway.growth.crown_allometry import breast_height_diameter as breast_height_diameter
    from tree_sway.growth.crown_allometry import crown_size as crown_size
    from tree_sway.growth.growing import grow as grow
    from tree_sway.growth.growing import height_of_stem as height_of_stem
    from tree_sway.growth.growing import refuse_height as refuse_height
    from tree_sway.growth.growing import stem_range as stem_range
    from tree_sway.growth.stem_by_age import OLDEST as OLDEST
    from tree_sway.growth.stem_by_age import stem_growth as stem_growth
    from tree_sway.growth.stem_by_age import stem_of_age as stem_of_age
else:
    __getattr__, __dir__, __all__ = face(__name__)
