# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree in the wind: laws that hold for every model."""

from __future__ import annotations

import resource
import tracemalloc

import numpy as np
import pytest
from scipy.integrate import quad
from simulators import FULL, OBSERVED, swaying

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import ParameterError, SpeciesError
from tree_sway.growth.builtin import builtin_tree, BUILTIN_TREES

MOVING = [4, 'branch', *FULL, *OBSERVED]
FEW = pytest.mark.xfail(
    strict=True, reason='few coordinates are chosen by winds that are not mirrored in this plane'
)
DT = 1.0 / 60.0


def gusts(n, seed=3):
    rng = np.random.default_rng(seed)
    return np.array([6.0, 2.0, 0.5]) + np.cumsum(rng.normal(0.0, 0.6, (n, 3)), axis=0)


def run(sim, winds, dt=DT):
    """Poses after each wind, (k, n, 7)."""
    frames = []
    for wind in winds:
        sim.step(wind, dt)
        frames.append(sim.place().copy())
    return np.array(frames)


@pytest.fixture(params=MOVING)
def model(request):
    return request.param


def test_the_same_wind_gives_the_same_bits(fork, model):
    winds = gusts(100)
    one, other = (run(swaying(fork(), model), winds) for _ in range(2))
    assert one.tobytes() == other.tobytes()


def test_without_wind_a_tree_is_exactly_at_rest(fork, model):
    sim = swaying(fork(), model)
    rest = sim.place().copy()
    frames = run(sim, np.zeros((50, 3)))
    assert (frames == rest).all()
    # The tip is found from its pose, to rounding.
    assert sim.tip_displacement == pytest.approx(np.zeros(3), abs=1e-14)


@pytest.mark.parametrize('model', [0, *MOVING])
def test_a_westerly_bends_the_tree_of_every_model_to_the_east(fork, model):
    bends_east(fork(), model)


@pytest.mark.long
@pytest.mark.parametrize('name', BUILTIN_TREES)
@pytest.mark.parametrize('model', [0, 'branch', 6, 12, *FULL])
def test_a_westerly_bends_every_tree_on_every_model_to_the_east(name, model):
    bends_east(builtin_tree(name), model)


def bends_east(tree, model, **changes):
    sim = swaying(tree, model, damping_ratio=0.5, **changes)
    rest = sim.place()[:, :3].copy()
    for _ in range(240):
        sim.step([6.0, 0.0, 0.0], DT)
    moved = sim.place()[:, :3] - rest
    if model == 0:
        assert not moved.any()
        return
    assert sim.tip_displacement[0] > 1e-5
    mean = (moved * tree.length[:, None]).mean(axis=0)
    assert mean[0] > 5.0 * abs(mean[1])


@pytest.mark.parametrize('model', ['branch', pytest.param(4, marks=FEW), *FULL])
def test_mirrored_wind_gives_mirrored_motion(mirror_fork, model):
    tree, partner = mirror_fork()
    mirror = np.array([1.0, -1.0, 1.0])
    winds = gusts(150)
    one = run(swaying(tree, model), winds)
    other = run(swaying(tree, model), winds * mirror)
    assert np.abs(one[-1] - one[0]).max() > 1e-3
    assert other[:, partner, :3] == pytest.approx(one[:, :, :3] * mirror, abs=1e-9)


@pytest.mark.parametrize('heading', [0.7, np.pi])
@pytest.mark.parametrize('model', ['branch', *FULL])
def test_a_turned_tree_in_turned_wind_moves_alike(fork, model, heading):
    tree = fork()
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    turned = tree_from_segments(
        tree.start @ turn,
        tree.end @ turn,
        np.stack([tree.base_diameter, tree.tip_diameter], axis=1),
        parent=tree.segment_parent,
        branch=tree.branch_of_segment,
    )
    winds = gusts(60)
    one, other = (swaying(t, model) for t in (tree, turned))
    moved = run(one, winds)[:, :, :3]
    assert np.ptp(moved, axis=0).max() > 5e-3
    assert run(other, winds @ turn)[:, :, :3] == pytest.approx(moved @ turn, abs=1e-12)


@pytest.mark.usefixtures('memory_alone')
@pytest.mark.parametrize('model', [0, *MOVING])
def test_a_step_allocates_nothing(fork, model):
    sim = swaying(fork(), model)
    wind, out = np.array([5.0, 1.0, 0.0]), np.zeros((sim.tree.n_segments, 7))
    for _ in range(3):
        sim.step(wind, DT)
        sim.place(out)
    grown, highest = [], []
    tracemalloc.start()
    try:
        for _ in range(3):  # what other threads take meanwhile only adds: the least is ours
            sim.step(wind, DT)
            sim.place(out)
            before, _ = tracemalloc.get_traced_memory()
            tracemalloc.reset_peak()
            for _ in range(500):
                sim.step(wind, DT)
                sim.place(out)
            after, peak = tracemalloc.get_traced_memory()
            grown.append(after - before)
            highest.append(peak - before)
    finally:
        tracemalloc.stop()
    # A few Python numbers come and go; no array does.
    assert min(grown) < 512
    assert min(highest) < 2048


@pytest.mark.parametrize('taper', [0.0, 0.6])
def test_static_deflection_is_the_beams(stem, model, taper):
    length, base, wind = 1.2, 0.012, 5.0
    tree = stem(length, base, base * (1 - taper), cuts=8)
    sim = swaying(tree, model, gravity=0.0, damping_ratio=1.0)
    for _ in range(1200):
        sim.step([wind, 0.0, 0.0], DT)
    sim.place()

    def moment(x):
        return quad(lambda s: (s - x) * (1 - taper * s), x, 1)[0]

    unit = quad(lambda x: moment(x) * (1 - x) / (1 - taper * x) ** 4, 0, 1)[0]
    load = 0.5 * 1.225 * sim.models[0].species.bare_drag_coefficient * wind**2 * base
    tip = unit * load * length**4 / (sim.models[0].species.modulus * np.pi / 64 * base**4)
    assert sim.tip_displacement[0] == pytest.approx(tip, rel=2e-3)
    assert abs(sim.tip_displacement[1]) < 1e-9


@pytest.mark.parametrize('model', MOVING)
def test_the_step_is_of_second_order(fork, model):
    def tip_after(n):
        sim = swaying(fork(), model, gravity=0.0, enrich='stem')
        h = 1.0 / n
        for k in range(n):
            # Mean over the step of 5 + 3 cos 4t. It begins with its largest value: what reaches
            # limbs of an observed tree from before the beginning is the wind of the first step.
            mean = 5.0 + 3.0 * (np.sin(4 * (k + 1) * h) - np.sin(4 * k * h)) / (4 * h)
            sim.step([mean, 0.0, 0.0], h)
        sim.place()
        return sim.tip_displacement.copy()

    truth = tip_after(4096)
    # The stiffest modes of `full` need fine steps, in which its load is iterated as well. Gusts
    # that cross a crown are remembered by steps of 1/16 s, into which short ones are joined.
    fine = {4: (64, 128), 'full': (512, 1024), 'observed': (16, 32)}
    steps = fine.get(model, (128, 256))
    error = [np.abs(tip_after(n) - truth).max() for n in steps]
    order = np.log2(error[0] / error[1])
    assert order > 1.65
    # What the table adds shrinks faster yet, until it is all that is left.
    assert order < 2.35 or model in {4, 'observed'}


def test_place_writes_where_it_is_reported(fork):
    sim = swaying(fork(), 'branch')
    sim.step([8.0, 0.0, 0.0], DT)
    out = np.zeros((sim.tree.n_segments, 7))
    assert sim.place(out) is out
    tip = sim.tip_displacement.copy()
    assert (sim.place() == out).all()
    assert (sim.tip_displacement == tip).all()


def test_what_it_says_of_the_tree(fork):
    sim = swaying(fork(), 8, leaf_mass=np.array([0.0, 0.1, 0.1, 0.1]))
    assert sim.model == '8'
    assert sim.mass == pytest.approx(900.0 * sim.tree.volume.sum() + 0.3)
    assert (np.diff(sim.frequencies()) >= 0).all()
    assert len(sim.frequencies(3)) == 3


def test_errors_of_a_simulator(fork):
    with pytest.raises(SpeciesError, match="unknown species 'plastic'"):
        make_simulator(plastic(fork()))
    with pytest.raises(ParameterError, match='no_such_setting'):
        make_simulator(fork(), no_such_setting=1)


def plastic(tree):
    return tree_from_segments(
        tree.start, tree.end, tree.base_diameter, parent=tree.segment_parent, species='plastic'
    )


@pytest.mark.parametrize('model', ['branch', 4])
def test_memory_stays_flat_over_many_steps(fork, model):
    """No tracer of Python sees what compiled code allocates; the size of the process does."""
    sim = swaying(fork(), model)
    wind, out = np.array([5.0, 1.0, 0.0]), np.zeros((sim.tree.n_segments, 7))

    def sway(steps):
        for _ in range(steps):
            sim.step(wind, DT)
            sim.place(out)
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    warm = sway(5_000)
    # A leak of one array's header (a hundred bytes) per step would be 4 MiB.
    assert sway(40_000) - warm < 1024
