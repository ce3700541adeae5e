# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The comparison with MuJoCo, in the small."""

import sys

import numpy as np
import pytest
from tree_sway_lab.compare.exported_wind import compare_exported_wind, row_of
from tree_sway_lab.compare.mujoco_tree import mujoco_module, MujocoTree, take_warnings
from tree_sway_lab.compare.with_mujoco import compare_with_mujoco
from tree_sway_lab.example_trees import forked_tree
from tree_sway_lab.frame.frame import frame_model

from tree_sway.core.species.species import Species, species_named
from tree_sway.errors import MissingDependencyError
from tree_sway.growth.builtin import builtin_tree

WOOD = Species('example', 'example', 8.0e9, 900.0)


def test_missing_engine_is_named_with_its_cure(monkeypatch):
    monkeypatch.setitem(sys.modules, 'mujoco', None)
    with pytest.raises(MissingDependencyError, match='pip install mujoco'):
        mujoco_module()


def test_both_run_on_one_tree_and_agree():
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    # A stiff bush has modes that decay fast, which MuJoCo's dampers take at shorter steps only.
    tree = forked_tree(0.65, 0.6, generations=2)
    wind = np.tile([6.0, 2.0, 0.0], (20, 1))
    found = compare_with_mujoco(tree, WOOD, wind, model='full', steps=64)
    assert found.first_frequency == pytest.approx(1.0, abs=0.01)
    assert found.static_sway == pytest.approx(1.0, abs=0.01)
    assert found.step_error < 0.01
    assert found.error < 0.05
    assert found.speed_up > 0.0
    assert 'tip error over tip motion: full' in str(found)


def test_displacements_are_compared_by_their_mean_rms_and_correlation():
    ours = np.random.default_rng(0).normal(0.2, 0.1, (50, 4, 3))
    assert row_of('all', ours, 1.5 * ours).split() == ['all', '1.500', '1.500', '1.000']
    shaken = 0.2 + 2.0 * (ours - 0.2)
    mean, rms, correlation = map(float, row_of('all', ours, shaken).split()[1:])
    assert mean == pytest.approx(1.0, abs=0.1)
    assert rms > 1.15
    assert correlation == pytest.approx(1.0, abs=1e-3)


@pytest.mark.long
def test_the_exported_tree_sways_in_the_engines_wind_as_ours_does():
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    tree = builtin_tree('goldcrest', 0)
    wind = np.tile([8.0, 2.0, 0.0], (480, 1))
    text = compare_exported_wind(tree, species_named(tree.species), wind)
    rows = [line.split() for line in text.splitlines()[2:]]
    assert [' '.join(row[:-3]) for row in rows] == ['all segments', 'the stem', 'the highest']
    ratios = np.array([row[-3:-1] for row in rows], dtype=float)
    assert (np.abs(ratios - 1.0) < 0.15).all(), text


def test_with_weight_and_twist_it_sways_as_the_frame_and_is_at_rest_in_a_calm():
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    tree = forked_tree(0.65, 0.6, generations=3)
    model = MujocoTree(tree, WOOD, 0.05, match_beam=False, gravity=9.81)
    frame = frame_model(tree, WOOD.modulus, WOOD.density, 9.81, shear_ratio=WOOD.shear_ratio)
    assert model.frequencies[:6] == pytest.approx(frame.frequencies(6), rel=0.02)
    light = frame_model(tree, WOOD.modulus, WOOD.density, 0.0, shear_ratio=500.0)
    assert light.frequencies(1)[0] > 1.04 * model.frequencies[0]
    for _ in range(64):
        model.step(np.zeros(3), 1.0 / 3840.0)
    rest = tree.end[tree.branch_first[1:] - 1]
    assert model.tips() == pytest.approx(rest, abs=1e-6)


def test_its_warnings_are_reported_and_leave_no_log_behind(tmp_path, monkeypatch, capsys):
    mujoco = pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    monkeypatch.chdir(tmp_path)
    mujoco_module()
    take_warnings()
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><joint type="slide"/>'
        '<geom size="1" mass="1"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    data.qvel[0] = np.nan
    mujoco.mj_step(model, data)
    (warning,) = take_warnings()
    assert 'Nan' in warning
    assert not list(tmp_path.iterdir())
