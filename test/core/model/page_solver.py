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
        stiffness, damping = self.a['stiffness'], self.a['own_damping']
        self.whole, self.half = (after(h, stiffness, damping) for h in (dt, dt / 2))
        h, share = dt / 2, 1 / (1 + dt / 2 * damping + dt * dt / 4 * stiffness)
        euler = np.zeros_like(self.half)
        euler[:, 1] = np.stack([-h * stiffness * share, share, h * share], axis=1)
        euler[:, 0] = h * euler[:, 1] + [1, 0, 0]
        is_later = euler[:, 1, 2] > self.half[:, 1, 2]
        self.half[is_later] = euler[is_later]
        self.q, self.v, self.f = np.zeros((3, len(stiffness)))

    def moved(self, rows, force):
        state = np.stack([self.q, self.v, force], axis=1)
        return np.einsum('mij,mj->im', rows, state)

    def step(self, wind):
        speed = float(np.linalg.norm(wind))
        direction = np.asarray(wind) / speed if speed else np.array([1.0, 0.0, 0.0])
        c, n, c0 = self.a['drag_law']
        streamlined = np.clip(speed, 4, 20) ** -n if n else 1.0
        p = 0.5 * 1.225 * (c * streamlined + c0)
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
        a, x = self.a, self.a['shapes'] @ self.q
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
        return np.hstack([starts, orientations[:, [1, 2, 3, 0]]])
