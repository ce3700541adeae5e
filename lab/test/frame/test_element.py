# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Element matrices against the textbook's closed forms and against rigid motions."""

import numpy as np
import pytest
from tree_sway_lab.frame import element

E, G, RHO = 8.0e9, 3.0e9, 900.0
LENGTHS = np.array([0.7, 1.6])
WIDTH = np.array([[0.05, 0.02], [0.03, 0.03]])
BEND_Y, BEND_Z = [1, 5, 7, 11], [2, 4, 8, 10]
UNIFORM = 1


@pytest.fixture(scope='module')
def shapes():
    return element.element_shapes(LENGTHS)


@pytest.fixture(scope='module')
def width():
    return WIDTH[:, :1] + (WIDTH[:, 1:] - WIDTH[:, :1]) * element.POINTS


def rigid(length):
    """Coordinates of three small rigid shifts and three turns about the start, (6, 12)."""
    out = np.zeros((6, 12))
    for k in range(3):
        out[k, [k, 6 + k]] = 1.0
        out[3 + k, [3 + k, 9 + k]] = 1.0
        out[3 + k, 6:9] = np.cross(np.eye(3)[k], [length, 0.0, 0.0])
    return out


def test_the_uniform_beam_is_the_textbooks(shapes, width):
    k = element.elastic_stiffness(shapes, LENGTHS, width, E, G)[UNIFORM]
    length, d = LENGTHS[UNIFORM], WIDTH[UNIFORM, 0]
    inertia, area = np.pi / 64 * d**4, np.pi / 4 * d**2
    h = length
    bend = (
        E
        * inertia
        / h**3
        * np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h * h, -6 * h, 4 * h * h],
            ]
        )
    )
    assert k[np.ix_(BEND_Y, BEND_Y)] == pytest.approx(bend, rel=1e-12)
    mirror = np.diag([1, -1, 1, -1])  # a turn about y lowers what lies ahead
    assert k[np.ix_(BEND_Z, BEND_Z)] == pytest.approx(mirror @ bend @ mirror, rel=1e-12)
    assert k[0, 0] == pytest.approx(E * area / h) == pytest.approx(-k[0, 6])
    assert k[3, 3] == pytest.approx(2 * G * inertia / h) == pytest.approx(-k[3, 9])


def test_the_uniform_mass_is_the_textbooks(shapes, width):
    m = element.consistent_mass(shapes, LENGTHS, width, RHO)[UNIFORM]
    h = LENGTHS[UNIFORM]
    total = RHO * np.pi / 4 * WIDTH[UNIFORM, 0] ** 2 * h
    bend = (
        total
        / 420
        * np.array(
            [
                [156, 22 * h, 54, -13 * h],
                [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                [54, 13 * h, 156, -22 * h],
                [-13 * h, -3 * h * h, -22 * h, 4 * h * h],
            ]
        )
    )
    assert m[np.ix_(BEND_Y, BEND_Y)] == pytest.approx(bend, rel=1e-12)
    assert m[0, [0, 6]] == pytest.approx([total / 3, total / 6])
    polar = total * WIDTH[UNIFORM, 0] ** 2 / 8
    assert m[3, [3, 9]] == pytest.approx([polar / 3, polar / 6])


def test_axial_force_stiffens_as_the_textbook_says(shapes):
    force, moment = np.zeros((2, 5, 3)), np.zeros((2, 5, 3))
    force[..., 0] = 40.0
    k = element.geometric_stiffness(shapes, LENGTHS, force, moment)[UNIFORM]
    h = LENGTHS[UNIFORM]
    expected = (
        40.0
        / (30 * h)
        * np.array(
            [
                [36, 3 * h, -36, 3 * h],
                [3 * h, 4 * h * h, -3 * h, -h * h],
                [-36, -3 * h, 36, -3 * h],
                [3 * h, -h * h, -3 * h, 4 * h * h],
            ]
        )
    )
    assert k[np.ix_(BEND_Y, BEND_Y)] == pytest.approx(expected, rel=1e-12)
    assert np.abs(k[3]).max() == 0.0, 'no twist without a moment'


@pytest.mark.parametrize('which', [0, UNIFORM])
def test_rigid_motion_costs_nothing_and_weighs_what_the_wood_does(shapes, width, which):
    motion, h = rigid(LENGTHS[which]), LENGTHS[which]
    k = element.elastic_stiffness(shapes, LENGTHS, width, E, G)[which]
    assert np.abs(k @ motion.T).max() < 1e-9 * np.abs(k).max()
    m = motion @ element.consistent_mass(shapes, LENGTHS, width, RHO)[which] @ motion.T
    d0, d1 = WIDTH[which]
    mass = RHO * np.pi / 12 * h * (d0 * d0 + d0 * d1 + d1 * d1)
    assert m[:3, :3] == pytest.approx(mass * np.eye(3), abs=1e-12 * mass)
    first = RHO * np.pi / 4 * h**2 * (d0**2 / 2 + 2 * d0 * (d1 - d0) / 3 + (d1 - d0) ** 2 / 4)
    assert m[1, 5] == pytest.approx(first, rel=1e-12)
    assert m[2, 4] == pytest.approx(-first, rel=1e-12)
    polar = RHO * np.pi / 32 * h * np.mean(np.linspace(d0, d1, 20001) ** 4)
    assert m[3, 3] == pytest.approx(polar, rel=1e-3 if which == 0 else 1e-12)


def test_matrices_are_symmetric_and_of_full_rank_but_for_rigid_motion(shapes, width):
    for k in element.elastic_stiffness(shapes, LENGTHS, width, E, G):
        assert k == pytest.approx(k.T, rel=1e-12, abs=1e-6)
        scaled = k / np.sqrt(np.outer(np.diag(k), np.diag(k)))
        assert np.sum(np.linalg.eigvalsh(scaled) > 1e-9) == 6
    for m in element.consistent_mass(shapes, LENGTHS, width, RHO):
        assert np.linalg.eigvalsh(m).min() > 0.0


def test_a_load_is_shared_as_it_lies(shapes):
    even = element.load_rows(shapes, LENGTHS, np.ones((2, 5)))
    for rows, h in zip(even, LENGTHS, strict=True):
        assert rows[[1, 5, 7, 11], 1] == pytest.approx([h / 2, h * h / 12, h / 2, -h * h / 12])
        assert rows[[0, 6], 0] == pytest.approx([h / 2, h / 2])
    rising = element.load_rows(shapes, LENGTHS, np.tile(element.POINTS, (2, 1)))
    for rows, h in zip(rising, LENGTHS, strict=True):
        assert rows[[1, 5, 7, 11], 1] == pytest.approx(
            [3 * h / 20, h * h / 30, 7 * h / 20, -h * h / 20]
        )


def test_moment_terms_are_the_second_variation(shapes):
    """For linear turns -M . (theta x theta') joins ends: M (a1 b2 - a2 b1) / L per length."""
    moment = np.zeros((2, 5, 3))
    moment[..., 0] = 7.0
    k = element.geometric_stiffness(shapes, LENGTHS, np.zeros((2, 5, 3)), moment)[UNIFORM]
    assert k == pytest.approx(k.T)
    u = np.random.default_rng(2).normal(size=12)
    turn = [rows[UNIFORM] @ u for rows in shapes.rotation]
    bend = [rows[UNIFORM] @ u for rows in shapes.curvature]
    density = -7.0 * (turn[1] * bend[2] - turn[2] * bend[1])
    assert u @ k @ u == pytest.approx(LENGTHS[UNIFORM] * element.WEIGHTS @ density, rel=1e-12)
