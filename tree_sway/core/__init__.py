# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The core: from a tree and a wind to poses. Arrays in, arrays out.

It needs numpy, scipy and the native core; it knows no ROS, no files, no clock, no logging, and no
randomness without an ``rng`` argument. Read its houses in the order of the mechanics:

1. `tree` and `species`: segments and branches, wood, bark and leaves (`leaves`).
2. `drag`, `wind`: how air loads wood and leaves, and the wind from a sensor to a tree.
3. `setup`: a tree once becomes beams, matrices, modes, a table of loads.
4. `model`: `SwayModel`, the arrays that all this found: the wall between set-up and run.
5. `native`: the C++ of a step and a pose, called with checked arrays.
6. `run`: one tree, step by step.
7. `scene`: trees that stand somewhere, in one wind, on one grid of time.

`settings`, `tree_state`, `arrays`, `checks`, `rotation` and `random_source` are single modules,
each its own face. A change of how a tree sways begins in ``doc/sway_model.md``, whose equations
the files name, and ends in ``native/``; ``doc/architecture.md`` is the tour.
"""
