# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree as bodies on hinges: by its laws, by MuJoCo, and by the elements of SDF."""

from dataclasses import replace
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse.linalg import eigsh, LinearOperator
from scipy.spatial.transform import Rotation

from tree_sway.core.drag.drag_law import AIR_DENSITY
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.files.export.hinged_tree import hinged_tree, plain_names, poses_on_parents
from tree_sway.files.export.hinged_tree_writing import mjcf_of_tree, sdf_of_tree
from tree_sway.growth.builtin import builtin_tree

TREES = [
    'goldcrest',
    pytest.param('benjamina', marks=pytest.mark.long),
    pytest.param('broadleaf', marks=pytest.mark.long),
]
SDF = """
    sdf sdf/model sdf/model/link sdf/model/link/pose sdf/model/link/gravity
    sdf/model/link/inertial sdf/model/link/inertial/pose sdf/model/link/inertial/mass
    sdf/model/link/inertial/inertia sdf/model/link/inertial/inertia/ixx
    sdf/model/link/inertial/inertia/iyy sdf/model/link/inertial/inertia/izz
    sdf/model/link/visual sdf/model/link/visual/pose sdf/model/link/visual/geometry
    sdf/model/link/visual/geometry/cylinder sdf/model/link/visual/geometry/cylinder/radius
    sdf/model/link/visual/geometry/cylinder/length sdf/model/link/collision
    sdf/model/link/collision/pose sdf/model/link/collision/geometry
    sdf/model/link/collision/geometry/cylinder sdf/model/link/collision/geometry/cylinder/radius
    sdf/model/link/collision/geometry/cylinder/length sdf/model/joint sdf/model/joint/parent
    sdf/model/joint/child sdf/model/joint/axis sdf/model/joint/axis/xyz
    sdf/model/joint/axis/dynamics sdf/model/joint/axis/dynamics/damping
    sdf/model/joint/axis/dynamics/spring_reference
    sdf/model/joint/axis/dynamics/spring_stiffness sdf/model/joint/axis/limit
    sdf/model/joint/axis/limit/lower sdf/model/joint/axis/limit/upper
""".split()
"""Elements of SDF 1.9 (gazebosim/sdformat, folder sdf/1.9); those of axis2 are those of axis."""


def simulator_of(name):
    tree = builtin_tree(name, 0)
    return make_simulator(tree, species_named(tree.species), model=20)


@pytest.fixture(scope='module')
def simulator():
    return simulator_of('goldcrest')


def test_bodies_weigh_what_the_tree_does(simulator):
    hinged = hinged_tree(simulator)
    assert hinged.mass.sum() == pytest.approx(simulator.mass, rel=1e-9)
    assert (hinged.stiffness > 0.0).all()
    assert (0.0 < hinged.centre).all()
    assert (hinged.centre < simulator.tree.length).all()


def test_poses_on_parents_lead_back_to_the_poses(simulator):
    tree = simulator.tree
    for _ in range(30):
        simulator.step((9.0, 2.0, 0.0), 1 / 60)
    poses = simulator.place()
    simulator.reset()
    relative, found = poses_on_parents(tree, poses), poses.copy()
    for i, parent in enumerate(tree.segment_parent.tolist()):
        if parent >= 0:
            turn = Rotation.from_quat(found[parent, 3:])
            found[i, :3] = found[parent, :3] + turn.apply(relative[i, :3])
            found[i, 3:] = (turn * Rotation.from_quat(relative[i, 3:])).as_quat()
    np.testing.assert_allclose(found[:, :3], poses[:, :3], atol=1e-12)
    gap = Rotation.from_quat(found[:, 3:]).inv() * Rotation.from_quat(poses[:, 3:])
    assert gap.magnitude().max() < 1e-12


def test_names_are_plain_and_each_is_one(simulator):
    few = replace(simulator.tree, branch_names=('7 b', *simulator.tree.branch_names[1:-1], '7_b'))
    for tree in (simulator.tree, few):
        names = plain_names(tree)
        assert len(set(names)) == tree.n_segments
        assert all(re.fullmatch('[A-Za-z][A-Za-z0-9_]*', name) for name in names)


NAMES = {'null': 'a\0b', 'escape': 'a\x1b[1mb', 'markup': 'a"<&>b', 'umlaut': 'Bäume',
         'surrogate': '\ud800', 'no character': '\uffff', 'digit': '7'}  # fmt: skip


@pytest.mark.parametrize('name', NAMES.values(), ids=NAMES)
def test_a_name_of_any_characters_is_readable(fork, name, monkeypatch):
    simulator = make_simulator(fork(), model=4)
    monkeypatch.setattr(simulator, 'tree', replace(simulator.tree, name=name))
    assert simulator.tree.name == name
    plain = re.sub('[\0\x1b\ud800\uffff]', '_', name)
    assert ElementTree.fromstring(mjcf_of_tree(simulator)).get('model') == plain
    assert ElementTree.fromstring(sdf_of_tree(simulator)).find('model').get('name') == plain


@pytest.mark.parametrize('name', TREES)
def test_mujoco_sways_it_at_our_first_frequency(name):
    mujoco = pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    simulator = simulator_of(name)
    model = mujoco.MjModel.from_xml_string(mjcf_of_tree(simulator))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert model.nv == 3 * simulator.tree.n_segments
    assert mujoco.mj_getTotalmass(model) == pytest.approx(simulator.mass, rel=1e-6)
    # Springs carry its weight: it stays at rest.
    assert model.opt.gravity[2] < -9.0
    bodies = [model.body(each).id for each in plain_names(simulator.tree)]
    for _ in range(100):
        mujoco.mj_step(model, data)
        np.testing.assert_allclose(data.xpos[bodies], simulator.tree.start, atol=1e-6)
    data.qvel[:] = 0.0

    def weight_at(qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        moments = np.empty(model.nv)
        mujoco.mj_rne(model, data, 0, moments)
        return moments

    at_rest, tiny = weight_at(0.0), 1e-5
    stiffness = np.diag(model.jnt_stiffness)
    for joint, angles in enumerate(tiny * np.eye(model.nv)):
        stiffness[joint] += (weight_at(angles) - at_rest) / tiny
    root = cholesky(0.5 * (stiffness + stiffness.T), lower=True)
    data.qpos[:] = 0.0
    mujoco.mj_forward(model, data)

    def scaled(x):
        momentum = np.empty(model.nv)
        mujoco.mj_mulM(
            model, data, momentum, solve_triangular(root, np.ravel(x), trans=1, lower=True)
        )
        return solve_triangular(root, momentum, lower=True)

    operator = LinearOperator((model.nv, model.nv), scaled, dtype=np.float64)
    slowest = eigsh(operator, 1, which='LA', return_eigenvectors=False)[0]
    frequency = 1.0 / (2.0 * np.pi * np.sqrt(slowest))
    assert frequency == pytest.approx(simulator.frequencies(1)[0], rel=0.01)


@pytest.mark.parametrize('name', TREES)
def test_mujoco_is_stable_at_the_step_that_is_stated_and_not_at_twice_it(name):
    mujoco = pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    mujoco.set_mju_user_warning(lambda _text: None)
    text = mjcf_of_tree(simulator_of(name))
    (stated,) = re.findall(r'Largest stable time step ([0-9.e-]+) s', text)
    model = mujoco.MjModel.from_xml_string(text)
    assert model.opt.timestep <= float(stated)
    begun = 1e-3 * np.random.default_rng(0).standard_normal(model.nq)
    grown = {}
    for times in (1, 2):
        model.opt.timestep = times * float(stated)
        data = mujoco.MjData(model)
        data.qpos[:] = begun
        for _ in range(60):
            mujoco.mj_step(model, data)
        unstable = data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number > 0
        grown[times] = np.inf if unstable else np.abs(data.qpos).max()
    assert grown[1] < 0.5 * np.abs(begun).max()
    assert grown[2] > 1e3 * np.abs(begun).max()


def held_moments(tree, drag_area, wind):
    """Moment of our drag about the base of the tree at rest [N m], (3,)."""
    axis = Rotation.from_quat(tree.rest_poses[:, 3:]).as_matrix()[:, :, 0]
    across = wind - (axis @ wind)[:, None] * axis
    speed = np.linalg.norm(across, axis=1, keepdims=True)
    force = 0.5 * AIR_DENSITY * drag_area[:, None] * speed * across
    return np.cross(0.5 * (tree.start + tree.end) - tree.start[0], force).sum(axis=0)


@pytest.mark.parametrize('name', TREES)
def test_the_wind_of_mujoco_pushes_a_held_tree_as_ours_does(name):
    mujoco = pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    simulator = simulator_of(name)
    tree, drag_area = simulator.tree, hinged_tree(simulator).drag_area
    model = mujoco.MjModel.from_xml_string(mjcf_of_tree(simulator))
    data = mujoco.MjData(model)
    root = Rotation.from_quat(tree.rest_poses[0, 3:])
    for bearing in (0.0, 1.0, 2.5, 4.0):
        wind = 8.0 * np.array([np.cos(bearing), np.sin(bearing), 0.0])
        model.opt.wind[:] = wind
        mujoco.mj_forward(model, data)
        ours = root.inv().apply(held_moments(tree, drag_area, wind))[1:]
        gap = np.linalg.norm(data.qfrc_fluid[:2] - ours)
        assert gap < 0.07 * np.linalg.norm(ours)


@pytest.mark.long
def test_the_wind_of_mujoco_sways_the_tree_as_ours_does():
    """Mean and rms of the tip in gusts of 8 m/s, after 5 s."""
    mujoco = pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    rate, seconds = 60, 25.0
    simulator = simulator_of('goldcrest')
    tree = simulator.tree
    model = mujoco.MjModel.from_xml_string(mjcf_of_tree(simulator))
    data = mujoco.MjData(model)
    tip = int(np.argmax(tree.start[:, 2]))
    body = model.body(plain_names(tree)[tip]).id
    gusts = simulate_turbulence(8.0, rate=rate, duration=seconds, rng=np.random.default_rng(3))
    ours, theirs = [], []
    for number, wind in enumerate(gusts):
        simulator.step(wind, 1.0 / rate)
        model.opt.wind[:] = wind
        while data.time < (number + 1) / rate:
            mujoco.mj_step(model, data)
        ours.append(simulator.place()[tip, :3] - tree.start[tip])
        theirs.append(data.xpos[body] - tree.start[tip])
    ours, theirs = np.array(ours[5 * rate :]), np.array(theirs[5 * rate :])
    mean = np.linalg.norm(theirs.mean(axis=0)) / np.linalg.norm(ours.mean(axis=0))
    rms = np.sqrt((theirs**2).sum() / (ours**2).sum())
    assert mean == pytest.approx(1.0, abs=0.08)
    assert rms == pytest.approx(1.0, abs=0.08)
    assert np.corrcoef(ours[:, 0], theirs[:, 0])[0, 1] > 0.98


def test_sdf_has_the_elements_of_its_specification(simulator):
    root, tree = ElementTree.fromstring(sdf_of_tree(simulator)), simulator.tree
    assert root.get('version') == '1.9'

    def paths(element, before=''):
        yield (path := f'{before}{element.tag}'.replace('axis2', 'axis'))
        for child in element:  # comments have no tag
            yield from paths(child, f'{path}/')

    assert set(paths(root)) == set(SDF)
    model = root.find('model')
    names = {link.get('name') for link in model.iter('link')}
    assert len(names) == tree.n_segments
    frames = names | {'__model__', 'world'}
    poses = [pose.get('relative_to') for pose in model.iter('pose') if pose.get('relative_to')]
    assert len(poses) == tree.n_segments
    assert frames >= {*poses, *(parent.text for parent in model.iter('parent'))}
    assert {child.text for child in model.iter('child')} == names
    for pose in model.iter('pose'):
        count = 7 if pose.get('rotation_format') == 'quat_xyzw' else 6
        assert len([float(word) for word in pose.text.split()]) == count
    masses = sum(float(mass.text) for mass in model.iter('mass'))
    assert masses == pytest.approx(simulator.mass, rel=1e-6)


@pytest.mark.long
def test_drake_reads_the_sdf(tmp_path, simulator):
    parsing = pytest.importorskip('pydrake.multibody.parsing', reason='needs Drake')
    from pydrake.multibody.plant import MultibodyPlant

    path = tmp_path / 'tree.sdf'
    path.write_text(sdf_of_tree(simulator))
    plant = MultibodyPlant(0.002)
    parsing.Parser(plant).AddModels(str(path))
    plant.Finalize()
    context = plant.CreateDefaultContext()
    assert plant.num_positions() == 2 * simulator.tree.n_segments
    assert plant.CalcTotalMass(context) == pytest.approx(simulator.mass, rel=1e-6)
    for name, start in zip(plain_names(simulator.tree), simulator.tree.start, strict=True):
        placed = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(name)).translation()
        np.testing.assert_allclose(placed, start, atol=1e-6)
