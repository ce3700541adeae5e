# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A solver of prepared models in numpy, written from ``doc/sway_model.md`` alone.

It imports nothing of the library: what it needs beyond the arrays of the file is on that page.
"""

from __future__ import annotations

from itertools import pairwise
import json
from math import atan2, ceil, factorial, floor, log2, pi, sin, sqrt

import numpy as np
from numpy.polynomial.legendre import Legendre

SIN_45 = sin(pi / 4)


def after(h, stiffness, damping):
    """Exact solution after h: rows (q, v) by columns (q, v, f) of every coordinate, (m, 2, 3)."""
    system = np.zeros((len(stiffness), 3, 3))
    system[:, 0, 1] = system[:, 1, 2] = 1.0
    system[:, 1, 0], system[:, 1, 1] = -stiffness, -damping
    values, vectors = np.linalg.eig(system)
    scaled = vectors * np.exp(h * values)[:, None, :]
    return np.real(scaled @ np.linalg.inv(vectors))[:, :2]


def harmonics(x, y, z):
    """Real spherical harmonics of degree 1, 3 and 5, (21,)."""
    found, angle, level = [], atan2(y, x), sqrt(max(0.0, 1.0 - z * z))
    for degree in (1, 3, 5):
        for m in range(-degree, degree + 1):
            k = abs(m)
            p = level**k * Legendre.basis(degree).deriv(k)(z)
            scale = sqrt((2 * degree + 1) * factorial(degree - k) / factorial(degree + k))
            around = sin(k * angle) if m < 0 else np.cos(k * angle)
            found.append(scale * p * (sqrt(2.0) * around if m else 1.0))
    return np.array(found)


def product(a, b):
    """Product of quaternions w x y z."""
    w = a[0] * b[0] - a[1:] @ b[1:]
    return np.array([w, *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])


def quaternion(vector):
    """Quaternion of a rotation vector."""
    half = np.linalg.norm(vector) / 2
    return np.array([np.cos(half), *(0.5 * np.sinc(half / pi) * vector)])


def rotated(q, vector):
    """Rotate a vector by a quaternion."""
    twice = 2 * np.cross(q[1:], vector)
    return vector + q[0] * twice + np.cross(q[1:], twice)


class PageSolver:
    """A tree of an ``.npz`` file."""

    def __init__(self, path, dt):
        with np.load(path) as file:
            self.a = dict(file)
        self.about = json.loads(str(self.a['about']))
        self.dt = dt
        self.whole, self.half = self.steps(dt)
        self.q, self.v, self.f = np.zeros((3, len(self.a['stiffness'])))

    def steps(self, dt):
        """Return a step of dt, and half of it to where the load is found, (m, 2, 3)."""
        stiffness, damping = self.a['stiffness'], self.a['own_damping']
        whole, half = (after(h, stiffness, damping) for h in (dt, dt / 2))
        h, share = dt / 2, 1 / (1 + dt / 2 * damping + dt * dt / 4 * stiffness)
        euler = np.zeros_like(half)
        euler[:, 1] = np.stack([-h * stiffness * share, share, h * share], axis=1)
        euler[:, 0] = h * euler[:, 1] + [1, 0, 0]
        is_later = euler[:, 1, 2] > half[:, 1, 2]
        half[is_later] = euler[is_later]
        return whole, half

    def drag_density(self, speed):
        c, n, c0 = self.a['drag_law']
        return 0.5 * 1.225 * (c * (np.clip(speed, 4, 20) ** -n if n else 1.0) + c0)

    def moved(self, rows, force):
        state = np.stack([self.q, self.v, force], axis=1)
        return np.einsum('mij,mj->im', rows, state)

    def step(self, wind):
        speed = float(np.linalg.norm(wind))
        direction = np.asarray(wind) / speed if speed else np.array([1.0, 0.0, 0.0])
        p = self.drag_density(speed)
        s = min(p * speed**2, self.a['most_pressure'])
        before, r, change = self.energy(), self.half[:, 1, 2], 0
        passes, k = 1, 0
        while k < passes:
            force, slope = self.force(p, s, direction, *self.moved(self.half, self.f))
            change = (1.5 if k else 1) * (force - self.f) / (1 - slope * r) + 0.1 * change
            self.f = self.f + change
            if k == 0:
                passes = 1 + min(7, ceil(log2(max(*(-slope * r), 1))))
            k += 1
        self.q, self.v = self.moved(self.whole, self.f)
        most = max(before, self.a['most_energy'])
        if self.energy() > most:
            scale = sqrt(most / self.energy())
            self.q, self.v = scale * self.q, scale * self.v

    def energy(self):
        return float(self.a['stiffness'] @ self.q**2 + self.v @ self.v)

    def force(self, p, s, direction, q, v):
        a, (x, y, z) = self.a, direction
        turn = atan2(y, x) / (2 * pi) * 24
        u = turn - floor(turn)
        azimuths = [(floor(turn) % 24, 1 - u), ((floor(turn) + 1) % 24, u)]
        d = sum(weight * a['amount'][row] for row, weight in azimuths) @ q
        levels = sum(weight * a['levels'][row] for row, weight in azimuths)
        j = next((k for k in range(6) if d <= levels[k + 1]), 5)
        t = np.clip((d - levels[j]) / (levels[j + 1] - levels[j]), 0, 1)
        g = max(0, (abs(z) - SIN_45) / (1 - SIN_45))
        pole = int(z > 0)
        rise = {row: np.diff(a['equilibrium'][row, j : j + 2], axis=0)[0] for row, _ in azimuths}
        away = q - sum(w * (a['equilibrium'][row, j] + t * rise[row]) for row, w in azimuths)
        load = harmonics(x, y, z) @ a['harmonics'] + g * q @ a['steep_turning'][pole]
        damped, slope = g * v @ a['steep_damping'][pole], g * np.diagonal(a['steep_damping'][pole])
        for row, weight in azimuths:
            load = load + (1 - g) * np.clip(z, -SIN_45, SIN_45) * weight * q @ a['lean'][row]
            for level, share, offset in ((j, 1 - t, t / 2), (j + 1, t, -(1 - t) / 2)):
                c = (1 - g) * weight * share
                from_corner = away + offset * rise[row]
                load = load + c * (a['load'][row, level] + from_corner @ a['turning'][row, level])
                damping = a['damping'][row, level]
                damped = damped + c * v @ damping
                slope = slope + c * (np.diagonal(damping) - a['cross_damping'][row, level])
        drag = p * sqrt(s / p + a['motion'] @ v**2)
        return s * np.clip(load, -a['limit'], a['limit']) + drag * damped, drag * slope

    def poses(self):
        """Poses: start of each segment, orientation x y z w, (n, 7)."""
        starts, orientations = self.placed(self.a['shapes'] @ self.q)
        return np.hstack([starts, orientations[:, [1, 2, 3, 0]]])

    def placed(self, x):
        """Return starts and orientations w x y z of the segments at key rotations."""
        a = self.a
        near, far, right = np.deg2rad([30, 45, 90]) ** 2
        first, parent = a['branch_first'], a['branch_parent']
        starts, orientations = np.zeros((first[-1], 3)), np.zeros((first[-1], 4))
        bases, passed_on = [], []
        for branch, (begin, end) in enumerate(pairwise(first)):
            own = int(a['branch_coordinate'][branch])
            keys = x[own : own + int(a['branch_keys'][branch])]
            tau = keys[0] ** 2 + keys[1] ** 2
            blend = np.clip((tau - near) / (far - near), 0, 1)
            skew, tip = a['branch_skew'][branch]
            bent, children = keys.copy(), keys.copy()
            bent[:2] *= 1 + min(tau, right) * (skew + blend * (tip - skew))
            children[:2] *= 1 + min(tau, right) * skew
            passed_on.append(children)
            if parent[branch] < 0:
                base, at = np.array([1.0, 0, 0, 0]), a['tree_start'][0]
            else:
                below, seat = parent[branch], a['branch_base_segment'][branch]
                turns = a['branch_twist'][branch, : len(passed_on[below]), 3:]
                base = product(bases[below], quaternion(passed_on[below] @ turns))
                at = starts[seat] + rotated(orientations[seat], a['branch_offset'][branch])
            bases.append(base)
            e1, e2 = a['branch_frame'][branch, 1:]
            for i in range(begin, end):
                bend = bent @ a['segment_turn'][i, : len(bent)]
                more = blend * (a['segment_tip_slope'][i] - a['segment_slope'][i])
                bend = bend + more * (bent[0] * e2 - bent[1] * e1)
                turned = product(base, quaternion(bend))
                starts[i], orientations[i] = at, product(turned, a['segment_rest'][i])
                at = at + rotated(turned, a['segment_chord'][i])
        return starts, orientations


class LimpPageSolver(PageSolver):
    """A limp tree of an ``.npz`` file, in wind that reaches all of it at once."""

    def __init__(self, path, dt):
        super().__init__(path, dt)
        a, self.m = self.a, len(self.q)
        self.root = np.tile(np.sqrt(a['segment_mass'] / 2)[:, None], (2, 1))
        self.down = np.array([0.0, 0.0, -self.about['settings']['gravity']])
        lengths = np.linalg.norm(a['tree_end'] - a['tree_start'], axis=1)
        first = a['branch_first'][:-1]
        branch = np.repeat(np.arange(len(first)), np.diff(a['branch_first']))
        wood = lengths * (a['tree_base_diameter'] + a['tree_tip_diameter']) / 2
        of_wood = np.add.reduceat(wood, first)
        leaves = np.maximum(a['branch_area'] - of_wood, 0) / np.add.reduceat(lengths, first)
        clad = np.minimum(a['branch_area'] / of_wood, 1)
        self.area = np.tile((wood * clad[branch] + lengths * leaves[branch]) / 2, 2)
        self.air = np.tile(a['branch_speed'][branch][:, None], (2, 1))
        apart = sqrt(1 / 3) / 2
        self.from_start = np.concatenate([(0.5 + by) * lengths for by in (-apart, apart)])[:, None]
        # Coordinates in which the inertia of the points at rest is 1, by turns of their keys.
        turns = a['shapes'].T
        at_rest = np.array([self.column(x, np.zeros(len(x)), both=True) for x in turns])
        self.factor = np.linalg.cholesky(at_rest @ at_rest.T)
        unit = np.linalg.inv(self.factor)
        self.turns, self.columns = unit @ turns, unit @ at_rest
        gravity = (self.root * self.down).ravel()
        self.weight_at_rest, self.slopes = self.columns @ gravity, unit @ a['weight_slopes']
        self.linear, self.gravity = at_rest @ gravity, gravity
        self.height = gravity @ self.places(np.zeros(len(a['shapes'])))[0]
        per_mass = np.repeat(2 * self.area * self.air[:, 0] / self.root[:, 0] ** 2, 3)
        self.damping = self.columns**2 @ per_mass
        self.change, self.weight = np.zeros((self.m, self.m)), np.zeros(self.m)
        self.next, self.allowed, self.n_bounded = 0, np.inf, 0

    def places(self, x):
        """Points times the roots of their masses, (6 n,), and directions, (2 n, 3)."""
        starts, orientations = self.placed(x)
        along = np.tile([rotated(q, np.array([1.0, 0, 0])) for q in orientations], (2, 1))
        points = np.tile(starts, (2, 1)) + self.from_start * along
        return (self.root * points).ravel(), along

    def column(self, direction, x, *, both=False):
        amount = 1e-5 / np.abs(direction).max()
        back = -amount if both else 0.0
        ahead, behind = (self.places(x + by * direction)[0] for by in (amount, back))
        return (ahead - behind) / (amount - back)

    def motion(self, v):
        return v @ v + v @ self.change @ v

    def step(self, wind):
        speed = float(np.linalg.norm(wind))
        longest = min(0.04, max(1 / 480, 4 / max(speed**2, 1)))
        n = ceil(min(max(self.dt / longest - 1e-9, 1), 1000))
        for _ in range(n):
            self.part(np.asarray(wind), speed, self.dt / n)

    def part(self, wind, speed, h):
        a, p = self.a, self.drag_density(speed)
        shapes, (whole, half) = a['shapes'], self.steps(h)
        middle, rate = self.moved(half, self.f)
        x, turning = shapes @ middle, shapes @ rate
        fastest = np.abs(turning).max()
        ahead = 0.01 / fastest if fastest else 0.0
        here, along = self.places(x)
        after, before = (self.places(x + side * ahead * turning)[0] for side in (1, -1))
        per_time = 0.5 / ahead if ahead else 0.0
        u = self.air * wind - per_time * (after - before).reshape(-1, 3) / self.root
        u = u - np.sum(u * along, axis=1)[:, None] * along
        drag = (self.area * np.linalg.norm(u, axis=1))[:, None] * u / self.root

        oldest = 0.27 if speed < 15 else 0.1
        count = ceil(min(max(h * fastest / oldest, 1 / 8), 1) * self.m)
        rows = (self.next + np.arange(count)) % self.m
        self.next = (self.next + count) % self.m
        motion = self.motion(self.v)
        self.columns[rows] = [self.column(self.turns[row], x) for row in rows]
        inertia = self.columns[rows] @ self.columns.T
        self.change[rows] = inertia - np.eye(self.m)[rows]
        self.change[:, rows] = self.change[rows].T
        bent = self.weight_at_rest[rows] + self.slopes[rows] @ middle
        self.weight[rows] = self.columns[rows] @ self.gravity - bent
        v = self.v * (sqrt(motion / self.motion(self.v)) if motion else 1.0)

        load = p * (self.factor @ (self.columns @ drag.ravel()))
        across = r = np.zeros(self.m)
        if ahead:
            across = -self.columns @ (after + before - 2 * here) / ahead**2
            r = (rate + self.change @ rate) / self.motion(rate)
            across = across - (across @ rate) * r
        force = self.force_of_part(load + self.weight, v, whole, h, p * speed, across, r)
        q1, v1 = np.einsum('mij,mj->im', whole, np.stack([self.q, v, force], axis=1))
        fastest = np.abs(shapes @ v1).max()
        if fastest > 40:
            q1, v1 = self.q + 40 / fastest * (q1 - self.q), 40 / fastest * v1
            self.n_bounded += 1
        kinetic = self.motion(v1) / 2
        moving = kinetic + a['stiffness'] @ q1**2 / 2
        fallen = self.gravity @ self.places(shapes @ q1)[0] - self.height
        energy = moving + self.linear @ q1 + q1 @ a['weight_slopes'] @ q1 / 2 - fallen
        self.allowed += load @ (q1 - self.q)
        if energy > self.allowed:
            left = max(kinetic - (energy - self.allowed), 0)
            v1 = v1 * sqrt(left / kinetic)
            energy += left - kinetic
        self.allowed = min(self.allowed, energy + 0.05 * moving)
        self.q, self.v, self.f = q1, v1, force

    def force_of_part(self, wanted, v, whole, h, drag, across, r):
        """Solve for the force: implicit in inertia and drag, and turning with the motion."""
        half = np.maximum(np.sqrt(self.a['stiffness']) * h / 2, 1e-12)
        assert (half < 1.25).all()  # slower than coordinates that are not coupled
        T, by_force = np.tan(half) / half, whole[:, 1, 2] / h
        free = (whole[:, 1, 0] * self.q + (whole[:, 1, 1] - 1) * v) / h
        root = np.sqrt(h / 2 * self.damping)
        damped = drag * root[:, None] * (self.change + np.eye(self.m)) * root
        turn = np.outer(across, r) - np.outer(r, across)
        matrix = np.diag(T / by_force) + self.change + damped - h / 2 * turn
        right = T * wanted - self.change @ free + damped @ (by_force * self.f)
        return np.linalg.solve(matrix, right + turn @ (v + h / 2 * free)) / by_force
