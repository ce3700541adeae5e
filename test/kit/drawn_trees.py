# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees that tests draw by rule: stiff ones that fork, ones that hang, crooked ones, a sapling."""

from __future__ import annotations

from itertools import pairwise
import math

import numpy as np

from tree_sway.core.settings import Settings
from tree_sway.core.species.species import Species
from tree_sway.core.tree.building import tree_from_segments

UP = np.array([0.0, 0.0, 1.0])

WOOD = Species(
    'example', 'example', 8.0e9, 900.0, damping_bare=0.05, shear_ratio=1.0 / 14.0
)  # fmt: skip
"""Wood of these trees."""

SETTINGS = Settings(gravity=9.81)

_GOLDEN = math.pi * (3.0 - math.sqrt(5.0))


class Sketch:
    """A tree that is drawn branch by branch."""

    def __init__(self, seed=0):
        self.rng = np.random.default_rng(seed)
        self.start, self.end, self.diameter, self.parent, self.branch = [], [], [], [], []
        self.nodes = []

    def add(self, seat, node, direction, length, base, tip, cuts, sag=0.0):
        """Add an arc of even taper on a node of a branch (None: the ground); its number."""
        along = np.asarray(direction, float) / np.linalg.norm(direction)
        u = np.linspace(0.0, 1.0, cuts + 1)[:, None]
        nodes = length * (u * along + sag * u**2 * np.array([0.3, 0.2, -1.0]))
        return self._add(seat, node, nodes, np.linspace(base, tip, cuts + 1))

    def shoot(self, seat, node, direction, length, base, tip, cuts, rise=0.0, wander=0.0):
        """Add a shoot that turns by segment to the zenith, and at random, by angles in [deg]."""
        along = np.asarray(direction, float) / np.linalg.norm(direction)
        nodes = [np.zeros(3)]
        for _ in range(cuts):
            nodes.append(nodes[-1] + length / cuts * along)
            along = _lifted(along, rise)
            along = along + math.radians(wander) * self.rng.standard_normal(3)
            along /= np.linalg.norm(along)
        return self._add(seat, node, np.array(nodes), np.linspace(base, tip, cuts + 1))

    def _add(self, seat, node, nodes, thick):
        number, first = len(self.nodes), len(self.start)
        on = -1
        if seat is not None:
            seated, carrying = self.nodes[seat]
            node %= len(carrying)
            on, nodes = seated + node - 1, carrying[node] + nodes
        cuts = len(nodes) - 1
        self.start += list(nodes[:-1])
        self.end += list(nodes[1:])
        self.diameter += list(np.stack([thick[:-1], thick[1:]], axis=1))
        self.parent += [on, *range(first, first + cuts - 1)]
        self.branch += [number] * cuts
        self.nodes.append((first, nodes))
        return number

    def tree(self, **changes):
        given = {'parent': np.array(self.parent), 'branch': np.array(self.branch)} | changes
        return tree_from_segments(self.start, self.end, self.diameter, **given)


def towards(azimuth, elevation):
    """Return the unit vector at an azimuth from x and an elevation over the horizon in [deg]."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return np.array([math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])


def _lifted(direction, angle):
    level = math.hypot(direction[0], direction[1])
    if level == 0.0 or angle == 0.0:
        return direction
    then = math.atan2(direction[2], level) + math.radians(angle)
    then = min(max(then, -0.5 * math.pi), 0.5 * math.pi)
    x, y = direction[0] / level, direction[1] / level
    return np.array([x * math.cos(then), y * math.cos(then), math.sin(then)])


def stem(length=2.0, base=0.02, tip=None, cuts=6, direction=(0.0, 0.0, 1.0), species='broadleaf'):
    """One straight branch of even taper, cut in equal segments."""
    drawn = Sketch()
    drawn.add(None, 0, direction, length, base, base if tip is None else tip, cuts)
    return drawn.tree(branch=None, species=species)


def fork(fine=1):
    """Stem, two limbs and a twig, none in one plane, the limbs bent; cut `fine` times finer."""
    s = Sketch()
    trunk = s.add(None, 0, (0.05, 0.0, 1.0), 2.0, 0.030, 0.012, 4 * fine, sag=0.05)
    limb = s.add(trunk, 2 * fine, (1.0, 0.3, 0.6), 0.9, 0.014, 0.006, 3 * fine, sag=0.08)
    s.add(trunk, 4 * fine, (-0.5, 0.8, 0.7), 0.8, 0.011, 0.005, 2 * fine)
    s.add(limb, 2 * fine, (0.4, 1.0, 0.2), 0.4, 0.006, 0.003, 2 * fine, sag=-0.05)
    return s.tree()


def mirror_fork():
    """Make a tree that is its own mirror image in the plane y = 0, and each segment's partner."""
    s = Sketch()
    trunk = s.add(None, 0, (0.1, 0.0, 1.0), 1.5, 0.02, 0.01, 3)
    for side in (1.0, -1.0):
        limb = s.add(trunk, 2, (0.4, side, 0.6), 0.7, 0.010, 0.005, 2)
        s.add(limb, 1, (1.0, 0.5 * side, 0.8), 0.3, 0.005, 0.003, 1)
    s.add(trunk, 3, (-1.0, 0.0, 0.5), 0.5, 0.008, 0.004, 2)
    tree = s.tree()
    image = tree.start * [1.0, -1.0, 1.0] + tree.end * [1.0, -1.0, 1.0]
    gap = np.linalg.norm(image[:, None] - (tree.start + tree.end)[None], axis=2)
    assert gap.min(axis=1).max() < 1e-12
    return tree, gap.argmin(axis=1)


def random_tree(seed, n=12):
    """Segments in random order on earlier ones' ends; returns start, end, diameter, parent."""
    rng = np.random.default_rng(seed)
    start, end = np.zeros((n, 3)), np.zeros((n, 3))
    parent = np.full(n, -1)
    end[0] = (0.0, 0.0, 1.0)
    for i in range(1, n):
        parent[i] = rng.integers(max(0, i - 4), i)
        start[i] = end[parent[i]]
        step = rng.normal(size=3) + np.array([0.0, 0.0, 0.5])
        end[i] = start[i] + rng.uniform(0.1, 0.6) * step / np.linalg.norm(step)
    diameter = rng.uniform(0.002, 0.02, n)
    order = rng.permutation(n)
    place = np.argsort(order)
    parents = np.where(parent[order] < 0, -1, place[parent[order]])
    return start[order], end[order], diameter[order], parents


def crown(children=(6, 3), cuts=6):
    """Draw a straight stem of 6 m whose limbs, and those on them, stand by the golden angle."""
    sizes = (6.0, 0.120, 0.044), (2.2, 0.044, 0.022), (0.9, 0.022, 0.013), (0.4, 0.013, 0.008)
    drawn, waiting = Sketch(), [(None, 0, UP, 0)]
    for seat, node, along, order in waiting:
        number = drawn.add(seat, node, along, *sizes[order], cuts)
        for child in range(children[order] if order < len(children) else 0):
            where = max(1, int(cuts * (2 + 4 * (child + 1) / children[order]) / 6))
            way = _aside(along, math.radians(55.0 - 5.0 * order), _GOLDEN * (len(waiting) + 1))
            waiting.append((number, where, way, order + 1))
    return drawn.tree(name=f'crown {len(waiting)}')


def _aside(along, angle, heading):
    """Turn a unit vector by an angle away from itself, towards a heading around itself."""
    across = np.cross(along, [1.0, 0.0, 0.0] if abs(along[2]) > 0.9 else UP)
    across /= np.linalg.norm(across)
    around = math.cos(heading) * across + math.sin(heading) * np.cross(along, across)
    return math.cos(angle) * along + math.sin(angle) * around


def weeping(seed=11, twigs=6):
    """Draw a stem with twigs of 1.4 m and 4 mm that hang from it: a limp tree."""
    to = Sketch(seed)
    to.shoot(None, 0, UP, 3.0, 0.05, 0.03, 5, wander=2.0)
    for k in range(twigs):
        to.shoot(
            0, 3 + k % 3, towards(360.0 / twigs * k, 20.0), to.rng.uniform(1.2, 1.6), 0.004, 0.002,
            6, rise=-25.0, wander=3.0,
        )  # fmt: skip
    return to.tree(name='weeping')


def young_whip(seed=302):
    """Draw a stem of 2.4 m, 12 mm thick, with nine twigs of half a metre: a limp tree."""
    to = Sketch(seed)
    to.shoot(None, 0, UP, 2.4, 0.012, 0.004, 12, wander=2.0)
    for k in range(9):
        to.shoot(
            0, 4 + k % 8, towards(k * 137.5, to.rng.uniform(40.0, 60.0)), to.rng.uniform(0.4, 0.8),
            0.0035, 0.0018, 6, rise=2.0, wander=4.0,
        )  # fmt: skip
    return to.tree(name='young whip')


def crooked(seed, n_branches=40, cuts=6):
    """Draw a random crooked tree, its branches 25 to 45 times as long as thick."""
    rng = np.random.default_rng(seed)
    start, end, thick, parent, number, branches = [], [], [], [], [], []

    def add(on, root, along, length, base, tip):
        nodes, along = [root], along / np.linalg.norm(along)
        for _ in range(cuts):
            along = along + rng.normal(0.0, 0.18, 3)
            along /= np.linalg.norm(along)
            nodes.append(nodes[-1] + along * length / cuts)
        width, first = np.linspace(base, tip, cuts + 1), len(start)
        start.extend(nodes[:-1]), end.extend(nodes[1:])
        thick.extend(pairwise(width))
        parent.extend([on, *range(first, first + cuts - 1)])
        number.extend([len(branches)] * cuts)
        branches.append((first, nodes, length, width, along))

    add(-1, np.zeros(3), np.array([*rng.normal(0.0, 0.1, 2), 1.0]), 6.0, 0.13, 0.04)
    while len(branches) < n_branches:
        lengths = np.array([each[2] for each in branches])
        first, nodes, below, width, along = branches[
            rng.choice(len(branches), p=lengths / lengths.sum())
        ]
        node, length = int(rng.integers(2, cuts + 1)), below * rng.uniform(0.3, 0.6)
        base = min(width[node] * rng.uniform(0.6, 0.9), length / rng.uniform(25.0, 45.0))
        if length >= 0.15 and base >= 0.004:
            ahead = 0.6 * along + rng.normal(0.0, 1.0, 3) + [0.0, 0.0, 0.3]
            add(first + node - 1, nodes[node], ahead, length, base, base * rng.uniform(0.3, 0.6))
    return tree_from_segments(start, end, thick, parent=np.array(parent), branch=np.array(number))


def branch_order(tree):
    """Branching order: 0 for the stem, one more than its parent's for the others, (b,)."""
    order = np.zeros(tree.n_branches, dtype=np.int64)
    for branch in np.flatnonzero(tree.branch_parent >= 0):
        order[branch] = order[tree.branch_parent[branch]] + 1
    return order
