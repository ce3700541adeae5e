# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The drag of air on wood and leaves, and how sure its numbers are.

`DragLaw` and `drag_density`: force per area and squared speed of a crown, which streamlines as the
wind rises (Vogel 1984; ``doc/models.md``). `crown_drag` joins wood and leaves of a tree to one
law. The spreads `WIND`, `DRAG`, `LEAVES` and `SHARE_WITHIN` are the standard deviations of
loads between trees of a kind, for bands.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.drag.drag_law import AIR_DENSITY as AIR_DENSITY
    from tree_sway.core.drag.drag_law import crown_drag as crown_drag
    from tree_sway.core.drag.drag_law import drag_density as drag_density
    from tree_sway.core.drag.drag_law import DragLaw as DragLaw
    from tree_sway.core.drag.drag_law import SHARED_AT as SHARED_AT
    from tree_sway.core.drag.drag_law import STREAMLINING_FROM as STREAMLINING_FROM
    from tree_sway.core.drag.drag_law import STREAMLINING_TO as STREAMLINING_TO
    from tree_sway.core.drag.load_spreads import DRAG as DRAG
    from tree_sway.core.drag.load_spreads import LEAVES as LEAVES
    from tree_sway.core.drag.load_spreads import SHARE_WITHIN as SHARE_WITHIN
    from tree_sway.core.drag.load_spreads import WIND as WIND
else:
    __getattr__, __dir__, __all__ = face(__name__)
