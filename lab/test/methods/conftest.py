# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A chain, a smooth wind and the reference that the tests of the methods share."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate, sample


class Swaying:
    """A chain of n segments for one second in a smooth wind, solved by the reference."""

    def __init__(self, n, frequency=1.0):
        self.chain, self.n = uniform_chain(n, frequency, 0.05), n
        self.first = self.wind(np.zeros(1))[0]
        self.truth = self.run(method_named('radau_ggl'), 320 if n == 1 else 160)

    def wind(self, t):
        load = np.stack([2 * np.sin(3 * t) + 1, 6 * np.cos(2 * t) - np.sin(5 * t)], -1)
        return np.repeat(0.8 * load[:, None, :] / self.n, self.n, axis=1)

    def run(self, method, steps):
        loads = sample(self.wind, method.nodes, 1 / steps, steps)
        return integrate(method, self.chain, loads, 1 / steps, first=self.first)

    def error(self, method, steps):
        """Root mean square at twenty times of the second."""
        theta, truth = self.run(method, steps).theta, self.truth.theta
        every, fine = steps // 20, (len(truth) - 1) // 20
        return np.sqrt(np.mean((theta[::every] - truth[::fine]) ** 2))


@pytest.fixture(scope='session')
def swaying():
    return Swaying(1)


@pytest.fixture(scope='session')
def swaying_chain():
    return Swaying(3)
