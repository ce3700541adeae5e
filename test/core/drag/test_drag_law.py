# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Drag on a branch: the integral along it, nothing along the grain, never an overshoot."""

from __future__ import annotations

from pathlib import Path
import re

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.integrate import quad
from simulators import FULL

from tree_sway.core.drag import drag_law
from tree_sway.core.drag.drag_law import AIR_DENSITY, drag_density
from tree_sway.core.model.branch_blocks import BranchBlocks
from tree_sway.core.run.assembly import bank_of
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.height_profile import WindProfile

DENSITY_AND_DRAG = 0.5 * 1.225 * 1.2


def drag(record, per_speed_squared, *wind, compliance=0.0):
    """Force alone, on a branch that does not turn."""
    blocks = BranchBlocks(np.array([record]))
    blocks.put('speed', np.ones(1))
    blocks.put('compliance', np.full(1, compliance))
    blocks.step(*wind, per_speed_squared)
    return blocks.forces()[0]


def record_of(tree, **changes):
    chosen = Settings(model='branch', gravity=0.0, **changes)
    return bank_of(prepare(tree, species_named('broadleaf'), chosen)).branches[0]


@pytest.mark.parametrize('direction', [(0, 0, 1), (1, 0, 0), (1, -2, 0.5)])
@pytest.mark.parametrize('wind', [(7.0, 0.0, 0.0), (3.0, -4.0, 2.0)])
def test_force_on_a_straight_branch_is_the_integral(stem, direction, wind):
    tree = stem(length=2.0, base=0.03, tip=0.01, direction=direction)
    along = (tree.end[-1] - tree.start[0]) / 2.0
    across = np.array(wind) - np.dot(wind, along) * along
    area = quad(lambda s: 0.03 - 0.01 * s, 0.0, 2.0)[0]
    expected = DENSITY_AND_DRAG * area * np.linalg.norm(across) * across
    found = drag(record_of(tree), drag_density(1.0, 1.2, 0.0), *wind)
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_the_force_in_a_profile_is_the_integral(stem):
    tree = stem(length=8.0, base=0.2, tip=0.02, cuts=400)
    profile = WindProfile('power', exponent=0.3)
    record = record_of(tree, profile=profile)
    found = drag(record, DENSITY_AND_DRAG, 10.0 * record['speed'], 0.0, 0.0)[0]
    law = quad(lambda z: (0.2 - 0.0225 * z) * 100.0 * (z / 10.0) ** 0.6, 0.0, 8.0)[0]
    assert found == pytest.approx(DENSITY_AND_DRAG * law, rel=1e-4)


def test_wind_along_a_branch_does_nothing(stem):
    record = record_of(stem(direction=(1.0, 2.0, 2.0)))
    found = drag(record, DENSITY_AND_DRAG, 5.0, 10.0, 10.0)
    assert found == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_bent_branch_is_met_wherever_the_wind_comes_from(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.02, 0.02, 20, sag=1.5)
    for wind in np.eye(3) * 5.0:
        assert np.linalg.norm(drag(record_of(drawn.tree()), DENSITY_AND_DRAG, *wind)) > 0.01


@settings(deadline=None)
@given(st.floats(0.0, 1e4), st.floats(1e-6, 1e6), st.integers(0, 1000))
def test_implicit_drag_never_overshoots(stem_record, speed, compliance, seed):
    """What the force does within the step leaves the air still faster than the branch, just so."""
    record = stem_record
    free = np.random.default_rng(seed).normal(size=3)
    free *= speed / np.linalg.norm(free)
    force = np.array(drag(record, DENSITY_AND_DRAG, *free, compliance=compliance))
    across = free * [1.0, 1.0, 0.0]
    left = across - compliance * force
    slack = 1e-9 * np.linalg.norm(across)
    assert left @ across >= -slack * np.linalg.norm(across)
    assert np.linalg.norm(left) <= np.linalg.norm(across) + slack
    explicit = DENSITY_AND_DRAG * record['area'] * np.linalg.norm(left) * left
    # A difference of near-equal numbers is what is left where the branch follows at once.
    rounding = 1e-13 * np.linalg.norm(across) * np.linalg.norm(across) * record['area']
    assert force == pytest.approx(explicit, rel=1e-6, abs=rounding + 1e-300)


@pytest.fixture(scope='module')
def stem_record(stem):
    return record_of(stem())


def test_without_compliance_drag_is_explicit(stem_record):
    free = drag(stem_record, DENSITY_AND_DRAG, 3.0, 4.0, 0.0, compliance=1e-12)
    assert np.linalg.norm(free) == pytest.approx(DENSITY_AND_DRAG * stem_record['area'] * 25.0)


@pytest.mark.parametrize('dt', [1e-4, 1 / 60, 0.5])
def test_a_hair_in_a_storm_follows_the_air_and_does_not_shake(stem, dt):
    tree = stem(length=0.2, base=2e-4, tip=1e-4, cuts=2, direction=(0, 1, 0))
    sim = make_simulator(tree, model='branch', gravity=0.0)
    for k in range(200):
        before = sim.place().copy()
        sim.step([100.0 * (-1) ** (k // 20), 30.0, 5.0], dt)
        poses = sim.place()
        assert np.isfinite(poses).all()
        tip_speed = np.linalg.norm(poses[:, :3] - before[:, :3], axis=1).max() / dt
        assert tip_speed < 110.0


def test_pressure_streamlines_where_it_was_measured():
    assert drag_density(15.0, 1.2, 0.0) == pytest.approx(0.5 * AIR_DENSITY * 1.2)
    pine = [drag_density(u, 3.07, 0.75) for u in (1.0, 4.0, 6.0, 20.0, 40.0)]
    assert pine[0] == pine[1] == pytest.approx(0.5 * 1.225 * 3.07 * 4.0**-0.75)
    assert pine[2] / pine[1] == pytest.approx(1.5**-0.75)
    assert pine[3] == pine[4]


def test_the_native_core_has_the_same_constants():
    text = (Path(__file__).parents[3] / 'native' / 'table.h').read_text(encoding='utf-8')
    found = dict(re.findall(r'\b(AIR_DENSITY|STREAMLINING_\w+) = ([\d.]+)', text))
    names = ('AIR_DENSITY', 'STREAMLINING_FROM', 'STREAMLINING_TO')
    assert {name: float(found[name]) for name in names} == {
        name: getattr(drag_law, name) for name in names
    }


def test_levers_are_those_of_the_load(stem):
    tree = stem(length=2.0, base=0.02, cuts=8)
    record = record_of(tree)
    assert record['area'] == pytest.approx(0.04)
    assert record['centre'] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    # Mean deflection of the uniform cantilever is 2/5 of its tip's.
    assert record['lever'] == pytest.approx(0.8, rel=1e-9)
    assert np.abs(record['load_mode']).max() == pytest.approx(0.8, rel=1e-9)
    # The branch damps itself at the root mean square: 104/405 of the tip's square.
    push, flow = (np.linalg.norm(record[k][0]) for k in ('load_mode', 'damping_mode'))
    assert push * flow == pytest.approx(4.0 * 104.0 / 405.0, rel=1e-9)


@pytest.mark.parametrize('model', ['branch', *FULL])
def test_a_branch_in_still_air_is_damped_as_its_pieces_are(model, stem):
    """
    A cantilever that swings freely loses in each cycle what the drag of its pieces takes.

    One over the amplitude grows by 8/3 of that drag over the inertia, ``8/3 c int psi^3 ds / int
    mu psi^2 ds``, psi the displacement per unit of the tip's.
    """
    length, width = 2.0, 0.02
    tree, wood = stem(length=length, base=width, cuts=8), species_named('broadleaf')
    sim = make_simulator(
        tree, model=model, gravity=0.0, damping_ratio=0.0, in_leaf=False, enrich='none'
    )
    s = np.linspace(0.0, 1.0, 2001)
    psi = (6.0 * s**2 - 4.0 * s**3 + s**4) / 3.0
    drag_of_pieces = DENSITY_AND_DRAG * width * np.trapezoid(psi**3, s)
    inertia = wood.density * np.pi / 4.0 * width**2 * np.trapezoid(psi**2, s)
    x, v = sim.banks[0].oscillators.motion()
    x[0] = 0.1
    sim.banks[0].oscillators.take_over(x, v)
    rate = 500
    per_cycle = rate / sim.frequencies(1)[0]
    tip = []
    for _ in range(round(6.2 * per_cycle)):
        sim.step((0.0, 0.0, 0.0), 1.0 / rate)
        sim.place()
        tip.append(np.hypot(*sim.tip_displacement[:2]))
    tip = np.array(tip)
    tops = np.flatnonzero((tip[1:-1] > tip[:-2]) & (tip[1:-1] >= tip[2:])) + 1
    growth = np.polyfit(0.5 * np.arange(len(tops)), 1.0 / tip[tops], 1)[0]
    assert growth == pytest.approx(8.0 / 3.0 * drag_of_pieces / inertia, rel=0.03)
