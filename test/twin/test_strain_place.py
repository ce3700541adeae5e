# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A pair of strain gauges as a sensor: strain by poses, and a tree that follows it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway.growth.growing import grow
from tree_sway.simulation.wood_strain import WoodStrain
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.sensor_place import as_orientation, bend_at, place_on, strain_of

DT = 1.0 / 60.0
SPRUCE = species_named('spruce')
TREE = grow('spruce', 16.0, rng=np.random.default_rng(3))
STEM = int(TREE.branch_first[1])


def test_strain_by_poses_is_that_of_the_curvature_of_the_wood() -> None:
    settings = Settings()
    wood = WoodStrain(TreeReductions(TREE, SPRUCE, settings))
    sim = make_simulator(TREE, SPRUCE, settings)
    rest = sim.place().copy()
    for k in range(1200):
        sim.step((8.0 + 2.0 * np.sin(k / 60.0), 3.0, 0.0), DT)
    poses, of_wood = sim.place(), wood.of(sim.rotations())
    stem = wood.branch == 0
    order = np.argsort(wood.height[stem])
    for height in (0.3, 1.3, 4.0, 8.0):
        place = place_on(TREE, f'{height} strain')
        strain = strain_of(bend_at(TREE, poses, place) - bend_at(TREE, rest, place))
        wanted = np.interp(height, wood.height[stem][order], of_wood[stem][order])
        assert np.hypot(*strain) == pytest.approx(wanted, rel=0.12), height
        # It leans to the east, and a little to the north: those sides are pressed.
        assert strain[1] < 2.0 * strain[0] < 0.0


def test_strain_is_passed_on_as_a_rotation_and_read_back() -> None:
    strain = np.array([[1e-4, -3e-4], [0.0, 0.0]])
    x, y, z, w = as_orientation(strain).T
    np.testing.assert_allclose(strain_of(2.0 * np.stack([x, y, z], 1)), strain, rtol=0.01)
    np.testing.assert_allclose(x**2 + y**2 + w**2, 1.0)


def test_a_branch_of_one_segment_has_no_joint() -> None:
    counts = np.diff(TREE.branch_first)
    short = TREE.branch_names[int(np.argmin(counts))]
    if counts.min() == 1:
        with pytest.raises(ParameterError, match='one segment'):
            place_on(TREE, f'{short}:0.5 strain')
    assert place_on(TREE, '1.3 strain facing 0').is_strain


def test_a_phone_at_a_place_of_strain_is_refused() -> None:
    sensor = MotionSensor('phone', place_on(TREE, '1.3 strain'))
    assert not sensor.offer(0.0, acceleration=(0.0, 0.0, 9.8), rate=(0.0, 0.0, 0.1))
    assert 'a quantity is missing' in sensor.trouble
    assert sensor.offer(0.1, orientation=as_orientation(np.array([[1e-4, 0.0]]))[0])


def moved(twin: ObservedTree, winds: Floats) -> Floats:
    """Tips of the stem (n, 3)."""
    found = []
    for wind in winds:
        twin.step(wind, DT)
        found.append(tips_of_poses(TREE, twin.place())[0])
    return np.array(found)


WINDS = simulate_turbulence(7.0, rate=60.0, duration=90.0, rng=5)


@cache
def truth() -> tuple[Floats, Floats]:
    """Strains (n, 2) and tips (n, 3) of a softer tree."""
    softer = replace(SPRUCE, modulus=0.8 * SPRUCE.modulus)
    true = make_simulator(TREE, softer, model=100, crown_coherence=0.3)
    place = place_on(TREE, '1.3 strain')
    rest, strains, tips = bend_at(TREE, true.place(), place), [], []
    for wind in WINDS:
        true.step(wind, DT)
        poses = true.place()
        strains.append(strain_of(bend_at(TREE, poses, place) - rest))
        tips.append(tips_of_poses(TREE, poses)[0])
    return np.array(strains), np.array(tips)


def error(twin: ObservedTree) -> float:
    """Return the error of the motion of the stem after 50 s, over the motion."""
    tips = truth()[1]
    wrong = (moved(twin, WINDS) - tips)[3000:]
    return float(np.sqrt(wrong.var(axis=0).sum() / tips[3000:].var(axis=0).sum()))


@cache
def error_alone() -> float:
    return error(ObservedTree(TREE, SPRUCE, at={}))


@pytest.mark.parametrize(('facing', 'offset'), [('', 0.0), ('', 3e-3), (' facing 0', 0.0)])
def test_a_tree_follows_the_strain_at_the_foot_of_an_unknown_one(
    facing: str, offset: float
) -> None:
    strains = truth()[0][::6] + offset
    measured = strains + 2e-6 * np.random.default_rng(1).normal(size=strains.shape)
    twin = ObservedTree(TREE, SPRUCE, at={'gauge': f'1.3 strain{facing}'})
    time = DT * (1.0 + np.arange(0, len(WINDS), 6))
    twin.replay('gauge', time, orientation=as_orientation(measured))
    found = error(twin)
    print(f'alone {error_alone():.3f}, with the gauge {found:.3f}', twin.problems)
    assert found < 0.4 * error_alone()
