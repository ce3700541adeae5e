# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""glTF as others read it: by pygltflib, by trimesh, and by the specification alone."""

import io
import json
import struct
import subprocess

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.leaves.foliage import leaf_clusters
from tree_sway.core.run.simulator_basis import basis_of
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import look_of, species_keys, species_named
from tree_sway.errors import FormatError
from tree_sway.files.export import breeze, gltf_tree
from tree_sway.files.export.gltf_tree import morphing_tree, skinned_tree
from tree_sway.files.export.spray_pictures import bark_picture, leaf_picture
from tree_sway.files.export.tree_export import write_gltf, write_tree
from tree_sway.files.export.tree_mesh import crown_mesh, wood_mesh
from tree_sway.growth.builtin import builtin_tree

Image = pytest.importorskip('PIL.Image', reason='Pillow is not installed')
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
KINDS = {
    5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32,
    5126: np.float32,
}  # fmt: skip
WIDTHS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}


@pytest.fixture(scope='module')
def simulator():
    tree = builtin_tree('benjamina', 0)
    return make_simulator(tree, species_named(tree.species), model=12)


@pytest.fixture(scope='module')
def leaves(simulator):
    return leaf_clusters(simulator.tree, np.random.default_rng(0), count=50)


def parsed(glb):
    """Document and arrays of a binary file, by the specification alone."""
    magic, version, length, size, kind = struct.unpack_from('<4sIII4s', glb)
    assert (magic, version, length, kind) == (b'glTF', 2, len(glb), b'JSON')
    document = json.loads(glb[20 : 20 + size])
    begin = 20 + size + 8
    assert begin % 4 == 0
    arrays = []
    for accessor in document['accessors']:
        view = document['bufferViews'][accessor['bufferView']]
        assert view['byteOffset'] % 4 == 0
        width, kind = WIDTHS[accessor['type']], np.dtype(KINDS[accessor['componentType']])
        count, stride = accessor['count'], view.get('byteStride', width * kind.itemsize)
        assert 'target' not in view or view['target'] == 34963 or stride % 4 == 0
        rows = np.frombuffer(glb, np.uint8, count * stride, begin + view['byteOffset'])
        array = rows.reshape(count, stride)[:, : width * kind.itemsize].copy().view(kind)
        for name, least in (('min', np.min), ('max', np.max)):
            if name in accessor:
                np.testing.assert_array_equal(accessor[name], least(array, axis=0))
        if accessor.get('normalized'):
            array = array / np.iinfo(kind).max
        arrays.append(array if width > 1 else array[:, 0])
    return document, arrays


def skinned_vertices(document, arrays, primitive):
    """Where a viewer draws the vertices of a skinned mesh, whatever the nodes have been set to."""
    skin, nodes = document['skins'][0], document['nodes']
    (root,) = [node for node in nodes if 'children' in node]
    assert root['children'] == skin['joints']
    inverse = arrays[skin['inverseBindMatrices']].reshape(-1, 4, 4).transpose(0, 2, 1)
    matrices = np.tile(np.eye(4), (len(skin['joints']), 1, 1))
    for matrix, joint in zip(matrices, skin['joints'], strict=True):
        turn = Rotation.from_quat(root['rotation'])
        matrix[:3, :3] = (turn * Rotation.from_quat(nodes[joint]['rotation'])).as_matrix()
        matrix[:3, 3] = turn.apply(nodes[joint]['translation'])
    matrices = matrices @ inverse
    attributes = {name: arrays[k] for name, k in primitive['attributes'].items()}
    blended = np.einsum('vk,vkij->vij', attributes['WEIGHTS_0'], matrices[attributes['JOINTS_0']])
    points = np.hstack([attributes['POSITION'], np.ones((len(attributes['POSITION']), 1))])
    return np.einsum('vij,vj->vi', blended, points)[:, :3]


def test_nodes_are_driven_by_the_poses_of_the_segments(simulator, leaves):
    tree = simulator.tree
    document, arrays = parsed(skinned_tree(tree, leaves).glb())
    (mesh,) = document['meshes']
    assert len(mesh['primitives']) == 2  # two draw calls, whatever the number of segments
    nodes = document['nodes']
    assert [nodes[k]['name'] for k in document['skins'][0]['joints']] == list(tree.segment_names)
    simulator.reset()
    for wind in (0.0, 12.0):
        for _ in range(60):
            simulator.step([wind, 0.3 * wind, 0.0], 1 / 60)
        poses = simulator.place().copy()
        gaps = [np.abs(nodes[k]['translation'] - poses[i, :3]).max() +
                np.abs(nodes[k]['rotation'] - poses[i, 3:]).max()
                for i, k in enumerate(document['skins'][0]['joints'])]  # fmt: skip
        # At rest the nodes are the poses; else they are set to them, as an engine does.
        assert (max(gaps) < 1e-9) == (wind == 0.0)
        for i, k in enumerate(document['skins'][0]['joints']):
            nodes[k]['translation'], nodes[k]['rotation'] = poses[i, :3], poses[i, 3:]
        for primitive, ours in zip(
            mesh['primitives'],
            (wood_mesh(tree), crown_mesh(tree, leaves, look_of(tree.species).spray, 4)),
            strict=True,
        ):
            drawn = skinned_vertices(document, arrays, primitive)
            np.testing.assert_allclose(drawn, ours.placed(poses) @ Y_UP.T, atol=2e-6)
    simulator.reset()


def test_other_programs_read_it(tmp_path, simulator, leaves):
    trimesh = pytest.importorskip('trimesh', reason='trimesh is not installed')
    write_tree(tmp_path / 'tree.glb', simulator.tree, leaves=leaves)
    scene = trimesh.load(tmp_path / 'tree.glb')
    assert len(scene.geometry) == 2
    # Few clusters are large.
    assert scene.extents[1] == pytest.approx(simulator.tree.height, rel=0.25)
    assert {'bark', 'leaves'} == {g.visual.material.name for g in scene.geometry.values()}


def test_pygltflib_reads_it(tmp_path, simulator):
    pygltflib = pytest.importorskip('pygltflib', reason='pygltflib is not installed')
    write_tree(tmp_path / 'tree.glb', simulator.tree)
    document = pygltflib.GLTF2().load(tmp_path / 'tree.glb')
    assert len(document.skins[0].joints) == simulator.tree.n_segments
    assert document.meshes[0].primitives[0].attributes.NORMAL is not None


@pytest.fixture(scope='module')
def morphing(simulator, leaves):
    return parsed(morphing_tree(simulator, leaves).glb())


def placed(document, arrays):
    """Vertices of the wood, and what targets do to them, in the frame of the tree."""
    (node,) = document['nodes']
    primitive, (scale, *_) = document['meshes'][0]['primitives'][0], node['scale']
    middle = Rotation.from_quat(node['rotation']).inv().apply(node['translation'])
    changes = np.array([arrays[target['POSITION']] for target in primitive['targets']])
    return scale * arrays[primitive['attributes']['POSITION']] + middle, scale * changes


def test_morph_targets_are_named_and_within_what_is_reported(simulator, morphing):
    document, arrays = morphing
    (mesh,) = document['meshes']
    count = len(mesh['extras']['targetNames'])
    assert 8 <= count == len(mesh['weights']) <= 32
    # What the linear form leaves out, at the weights of the file's own animation.
    (animation,) = document['animations']
    sampler = animation['samplers'][0]
    times, weights = (
        arrays[sampler['input']],
        arrays[sampler['output']].reshape(-1, count),
    )
    assert len(times) == len(weights) > 100
    rest, changes = placed(document, arrays)
    ours = wood_mesh(simulator.tree)
    frames = breeze.in_breeze(simulator, 20.0, lambda: ours.placed(simulator.place()))
    gaps, motions = [], []
    for number in range(0, len(frames), 60):
        wood = frames[number]
        drawn = rest + np.einsum('m,mvj->vj', weights[number], changes)
        gaps.append(np.linalg.norm(drawn - wood, axis=1))
        motions.append(np.linalg.norm(wood - rest, axis=1))
    assert 0.0 < np.sqrt(np.mean(np.square(gaps))) < 0.1 * np.sqrt(np.mean(np.square(motions)))


def test_the_breeze_begins_again_where_it_ends(morphing):
    document, arrays = morphing
    (animation,) = document['animations']
    sampler = animation['samplers'][0]
    times = arrays[sampler['input']]
    weights = arrays[sampler['output']].reshape(len(times), -1)
    np.testing.assert_array_equal(weights[-1], weights[0])
    assert times[-1] == pytest.approx(20.0)
    steps = np.abs(np.diff(weights, axis=0))
    assert (steps[[0, -1]] <= steps[1:-1].max(axis=0)).all()  # beside the seam as elsewhere


def test_floats_move_vertices_as_small_integers_do_and_need_no_extension(
    simulator, leaves, morphing
):
    document, arrays = parsed(morphing_tree(simulator, leaves, small=False).glb())
    assert not [key for key in document if key.startswith('extensions')]
    primitive = document['meshes'][0]['primitives'][0]
    targets = [each['POSITION'] for each in primitive['targets']]
    used = [*primitive['attributes'].values(), *targets]
    assert {document['accessors'][each]['componentType'] for each in used} == {5126}
    (points, moved), (same, rounded) = placed(document, arrays), placed(*morphing)
    np.testing.assert_allclose(points, same, atol=1e-6)
    np.testing.assert_allclose(moved, rounded, atol=document['nodes'][0]['scale'][0] / 250.0)
    assert document['meshes'][0]['extras'] == morphing[0]['meshes'][0]['extras']


def test_a_weight_is_a_coordinate_over_its_unit(simulator, morphing):
    document, arrays = morphing
    extras = document['meshes'][0]['extras']
    basis = basis_of(simulator)
    assert extras['basis'] == basis.digest
    coordinates = np.zeros(basis.n_coordinates)
    coordinates[2] = 0.01 * extras['unit'][2]
    poses = simulator.place_rotations(basis.rotations(coordinates)).copy()
    rest, changes = placed(document, arrays)
    wood = wood_mesh(simulator.tree)
    np.testing.assert_allclose(rest, wood.placed(simulator.tree.rest_poses), atol=1e-4)
    moved, change = wood.placed(poses) - rest, 0.01 * changes[2]
    assert np.linalg.norm(moved - change) < 0.05 * np.linalg.norm(moved) + 1e-4


def test_a_viewer_bounds_a_tree_that_morphs_by_little_more_than_it_is():
    """
    The box of three.js: that of rest, and on each side the largest motion of a target.

    The tree is slender, so that its height is no measure of its width.
    """
    tree = builtin_tree('goldcrest', 0)
    simulator = make_simulator(tree, species_named('goldcrest'), model=12)
    document, arrays = parsed(morphing_tree(simulator).glb())
    lows, highs, tops, feet = [], [], [], []
    for primitive in document['meshes'][0]['primitives']:
        at = arrays[primitive['attributes']['POSITION']]
        targets = [np.abs(arrays[each['POSITION']]).max(axis=0) for each in primitive['targets']]
        moved = np.max(targets, axis=0)
        feet.append(at.min(axis=0))
        tops.append(at.max(axis=0))
        lows.append(feet[-1] - moved)
        highs.append(tops[-1] + moved)
    bound, tree = (np.max(b, axis=0) - np.min(a, axis=0) for a, b in ((lows, highs), (feet, tops)))
    assert (bound < 1.2 * tree).all()
    # Blender draws weights up to 10.
    (animation,) = document['animations']
    assert 0.1 < np.abs(arrays[animation['samplers'][0]['output']]).max() < 10.0


def test_more_segments_than_joints(simulator, monkeypatch):
    monkeypatch.setattr(gltf_tree, '_MAX_JOINTS', 10)
    with pytest.raises(FormatError, match='997 segments, more than the 10 joints of a skin'):
        skinned_tree(simulator.tree)


def test_written_whole(tmp_path, simulator):
    path, document = tmp_path / 'tree.glb', skinned_tree(simulator.tree)
    write_gltf(path, document)
    assert path.read_bytes() == document.glb()


def test_textures_and_normals_are_where_viewers_look(simulator, leaves, morphing):
    for document, arrays in (morphing, parsed(skinned_tree(simulator.tree, leaves).glb())):
        for primitive in document['meshes'][0]['primitives']:
            attributes = {name: arrays[k] for name, k in primitive['attributes'].items()}
            texture, normals = attributes['TEXCOORD_0'], attributes['NORMAL']
            assert texture.min() == 0.0
            assert texture[:, 0].max() == pytest.approx(1.0)
            assert texture[:, 1].max() >= 1.0
            np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=0.01)


def test_leaves_and_bark_have_the_pictures_of_their_species(simulator, leaves):
    glb = morphing_tree(simulator, leaves).glb()
    document, arrays = parsed(glb)
    begin = 28 + struct.unpack_from('<I', glb, 12)[0]
    bark, leaf = document['materials']
    assert leaf['alphaMode'] == 'MASK'
    assert 'doubleSided' not in leaf
    assert 'alphaMode' not in bark
    # Each triangle of a leaf is there from both sides, lit alike.
    fronts, backs = arrays[document['meshes'][0]['primitives'][1]['indices']].reshape(2, -1, 3)
    np.testing.assert_array_equal(fronts, backs[:, ::-1])
    wanted = [bark_picture('smooth'), leaf_picture('benjamina')]
    for material, png in zip((bark, leaf), wanted, strict=True):
        texture = document['textures'][
            material['pbrMetallicRoughness']['baseColorTexture']['index']
        ]
        view = document['bufferViews'][document['images'][texture['source']]['bufferView']]
        at = begin + view['byteOffset']
        assert glb[at : at + view['byteLength']] == png
    image = np.asarray(Image.open(io.BytesIO(wanted[1])).convert('RGBA'))
    assert 0.2 < (image[..., 3] > 128).mean() < 0.8  # leaves, and what is between them
    seen = image[image[..., 3] > 128]
    assert seen[:, 1].mean() > 1.3 * seen[:, [0, 2]].mean()  # green


@pytest.mark.parametrize('species', [*species_keys(), 'of no table'])
def test_every_species_has_a_picture_of_its_leaves(species):
    image = Image.open(io.BytesIO(leaf_picture(species)))
    assert image.size == (256, 256)
    assert bark_picture(look_of(species).bark_pattern).startswith(b'\x89PNG')


def test_a_large_tree_is_at_most_six_megabytes():
    tree = builtin_tree('broadleaf', 0)
    simulator = make_simulator(tree, species_named('oak'), in_leaf=True)
    leaves = leaf_clusters(tree, np.random.default_rng(0), count=1500)
    for document in (skinned_tree(tree, leaves), morphing_tree(simulator, leaves)):
        assert len(document.glb()) < 6e6


@pytest.mark.parametrize('species', ['oak', 'birch', 'spruce', 'willow'])
def test_far_leaves_cover_as_much_as_near_ones(species):
    """As a renderer halves a picture with distance, and draws what is left of its alpha."""
    alpha = np.asarray(Image.open(io.BytesIO(leaf_picture(species))).convert('RGBA'))[..., 3] / 255
    near = (alpha > gltf_tree._CUTOFF).mean()
    while len(alpha) > 16:
        alpha = alpha.reshape(len(alpha) // 2, 2, -1, 2).mean(axis=(1, 3))
        assert (alpha > gltf_tree._CUTOFF).mean() > 0.9 * near


VALIDATE = """
const {validateBytes} = require('gltf-validator');
const bytes = require('fs').readFileSync(process.argv[1]);
validateBytes(new Uint8Array(bytes)).then((report) => console.log(JSON.stringify(report.issues)));
"""


@pytest.mark.long
def test_the_validator_of_khronos_finds_no_fault(tmp_path, simulator, leaves):
    """Needs Node.js and `npm install gltf-validator`, which NODE_PATH names."""
    for document in (skinned_tree(simulator.tree, leaves), morphing_tree(simulator, leaves)):
        write_gltf(tmp_path / 'tree.glb', document)
        command = ['node', '-e', VALIDATE, str(tmp_path / 'tree.glb')]
        try:
            run = subprocess.run(command, capture_output=True, text=True, check=True)
        except (FileNotFoundError, subprocess.CalledProcessError):
            pytest.skip('Node.js or its gltf-validator is not installed')
        issues = json.loads(run.stdout)
        assert (issues['numErrors'], issues['numWarnings']) == (0, 0)


@pytest.mark.long
def test_blender_reads_it_and_it_moves(tmp_path, simulator, leaves):
    bpy = pytest.importorskip('bpy', reason='needs Blender as a module (pip install bpy)')
    write_gltf(tmp_path / 'tree.glb', morphing_tree(simulator, leaves))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(tmp_path / 'tree.glb'))
    (shown,) = [each for each in bpy.data.objects if each.type == 'MESH']
    assert shown.dimensions.z == pytest.approx(simulator.tree.height, rel=0.25)
    places = []
    for frame in (10, 60):
        bpy.context.scene.frame_set(frame)
        drawn = shown.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        places.append([shown.matrix_world @ vertex.co for vertex in drawn.vertices])
    moved = max((b - a).length for a, b in zip(*places, strict=True))
    assert 1e-3 < moved < 0.5 * simulator.tree.height
