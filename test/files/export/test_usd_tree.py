# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""USD as Pixar's library and Blender read it."""

import errno
from pathlib import Path
import zipfile

import numpy as np
import pytest

from tree_sway.core.leaves.foliage import leaf_clusters
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.errors import FormatError
from tree_sway.files.export.breeze import in_breeze
from tree_sway.files.export.tree_mesh import wood_mesh
from tree_sway.files.export.usd_tree import branch_groups, influences, usd_of_tree
from tree_sway.files.export.usd_writing import write_usd
from tree_sway.growth.builtin import builtin_tree


@pytest.fixture(scope='module')
def simulator():
    tree = builtin_tree('goldcrest', 0)
    return make_simulator(tree, species_named(tree.species), model=20)


@pytest.fixture(scope='module')
def path(simulator, tmp_path_factory):
    leaves = leaf_clusters(simulator.tree, np.random.default_rng(0), count=50)
    path = tmp_path_factory.mktemp('usd') / 'tree.usda'
    path.write_text(usd_of_tree(simulator, leaves))
    return path


@pytest.fixture(scope='module')
def stage(path):
    usd = pytest.importorskip('pxr.Usd', reason='needs USD (pip install usd-core)')
    return usd.Stage.Open(str(path))


def skeleton(stage):
    from pxr import UsdSkel

    cache, root = UsdSkel.Cache(), stage.GetDefaultPrim()
    prim = root.GetChild('Skeleton')
    return prim, cache.GetSkelQuery(UsdSkel.Skeleton(prim))


def test_every_joint_is_where_our_segment_is_in_every_frame(stage, simulator):
    _, query = skeleton(stage)
    frames = in_breeze(simulator, 10.0, simulator.place)
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0.0, len(frames) - 1.0)
    assert stage.GetEndTimeCode() / stage.GetTimeCodesPerSecond() == pytest.approx(10.0)
    assert np.linalg.norm(frames[99][:, :3] - frames[0][:, :3], axis=1).max() > 0.01
    steps = np.abs(np.diff(frames, axis=0)).max(axis=(1, 2))
    np.testing.assert_array_equal(frames[-1], frames[0])
    assert steps[-1] <= steps[:-1].max()  # it begins again where it ends
    for k in (0, 60, 99):
        joints = np.array(query.ComputeJointSkelTransforms(k))
        np.testing.assert_allclose(joints[:, 3, :3], frames[k][:, :3], atol=1e-3)
    rest = np.array(query.ComputeJointSkelTransforms(0, True))
    np.testing.assert_allclose(rest[:, 3, :3], simulator.tree.start, atol=1e-4)


def test_the_wood_is_drawn_where_ours_is(path, simulator):
    usd = pytest.importorskip('pxr.Usd', reason='needs USD (pip install usd-core)')
    from pxr import Gf, UsdSkel

    stage = usd.Stage.Open(str(path))
    assert UsdSkel.BakeSkinning(UsdSkel.Root(stage.GetDefaultPrim()), Gf.Interval(60, 60))
    drawn = stage.GetDefaultPrim().GetChild('Wood').GetAttribute('points')
    placed = wood_mesh(simulator.tree).placed(in_breeze(simulator, 10.0, simulator.place)[60])
    np.testing.assert_allclose(np.array(drawn.Get(60)), placed, atol=2e-3)
    leaves = stage.GetDefaultPrim().GetChild('Leaves').GetAttribute('points')
    assert len(leaves.Get(60)) > 100


def test_it_says_what_unreal_asks_for(stage, simulator):
    prim, query = skeleton(stage)
    assert 'DynamicWindSkeletonAPI' in prim.GetMetadata('apiSchemas').GetAddedOrExplicitItems()
    values = {
        name: prim.GetAttribute(f'unreal:dynamicWind:{name}').Get()
        for name in (
            'jointNames', 'jointSimulationGroups', 'simulationGroupInfluences',
            'simulationGroupShiftTops', 'trunkSimulationGroups', 'isGroundCover',
            'gustAttenuation',
        )
    }  # fmt: skip
    joints = [joint.rpartition('/')[2] for joint in query.GetJointOrder()]
    assert list(values['jointNames']) == joints
    groups = np.array(values['jointSimulationGroups'])
    assert len(groups) == len(joints)
    assert set(groups) == set(range(len(values['simulationGroupInfluences'])))
    assert len(values['simulationGroupShiftTops']) == groups.max() + 1
    assert list(values['trunkSimulationGroups']) == [0]
    assert (values['isGroundCover'], values['gustAttenuation']) == (False, 0.0)


def test_the_stem_is_a_group_and_influences_are_slopes(simulator):
    tree, groups = simulator.tree, branch_groups(simulator.tree)
    assert set(groups[tree.segments_of(0)]) == {0}
    assert 0 not in groups[tree.branch_first[1] :]
    before = simulator.state()
    found = influences(simulator)
    assert found.max() == 1.0
    assert (found > 0.0).all()
    assert len(found) == groups.max() + 1
    np.testing.assert_array_equal(simulator.state().values, before.values)


@pytest.mark.long
def test_blender_reads_it_and_it_moves(path, simulator):
    bpy = pytest.importorskip('bpy', reason='needs Blender as a module (pip install bpy)')
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(path))
    (armature,) = [each for each in bpy.data.objects if each.type == 'ARMATURE']
    assert len(armature.pose.bones) == simulator.tree.n_segments
    heads = []
    for frame in (10, 60):
        bpy.context.scene.frame_set(frame)
        heads.append(np.array([tuple(bone.head) for bone in armature.pose.bones]))
    moved = np.linalg.norm(heads[1] - heads[0], axis=1)
    assert 1e-3 < moved.max() < 0.5 * simulator.tree.height


@pytest.mark.parametrize('suffix', ['.usda', '.usdz'])
def test_pictures_are_found_from_the_file(tmp_path, simulator, suffix):
    usd = pytest.importorskip('pxr.Usd', reason='needs USD (pip install usd-core)')
    from pxr import UsdShade

    leaves = leaf_clusters(simulator.tree, np.random.default_rng(0), count=50)
    path = tmp_path / f'gold{suffix}'
    write_usd(path, simulator, leaves)
    stage = usd.Stage.Open(str(path))
    root = stage.GetDefaultPrim()
    for kind, is_cut in (('Wood', False), ('Leaves', True)):
        material, _ = UsdShade.MaterialBindingAPI(root.GetChild(kind)).ComputeBoundMaterial()
        surface = material.ComputeSurfaceSource()[0]
        assert surface.GetIdAttr().Get() == 'UsdPreviewSurface'
        picture = stage.GetPrimAtPath(f'{material.GetPath()}/Picture')
        found = picture.GetAttribute('inputs:file').Get().resolvedPath.rstrip(']')
        assert found.endswith(f'gold_{"leaves" if is_cut else "bark"}.png')
        assert bool(surface.GetInput('opacityThreshold')) == is_cut
        count = len(root.GetChild(kind).GetAttribute('points').Get())
        assert len(root.GetChild(kind).GetAttribute('primvars:st').Get()) == count
    if suffix == '.usdz':
        data = path.read_bytes()
        for entry in zipfile.ZipFile(path).infolist():
            name, extra = (
                int.from_bytes(data[entry.header_offset + k :][:2], 'little') for k in (26, 28)
            )
            assert (entry.header_offset + 30 + name + extra) % 64 == 0
            assert entry.compress_type == zipfile.ZIP_STORED


def test_a_disk_that_fills_leaves_no_pictures_behind(tmp_path, simulator, monkeypatch):
    """The text is the largest file and the last: its pictures alone are of no use."""
    write = Path.write_bytes

    def until_full(self, data):
        if self.suffix == '.usda':
            raise OSError(errno.ENOSPC, 'No space left on device')
        return write(self, data)

    monkeypatch.setattr(Path, 'write_bytes', until_full)
    with pytest.raises(FormatError, match=r'gold\.usda: cannot be written: No space left'):
        write_usd(tmp_path / 'gold.usda', simulator)
    assert not list(tmp_path.iterdir())
