# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every method's declared order, measured."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.registry import method_named, METHODS

# Steps a second at which the leading error term rules: fine for first order, coarse for fifth.
STEPS = {1: 800, 2: 160, 4: 80, 5: 20}
# Baumgarte's gains grow as 1 / h: its fourth order falls to the second below an error of 1e-8.
LATE = {'baumgarte': 640}


@pytest.mark.parametrize('name', METHODS)
def test_measured_order_is_the_declared_one(name, swaying):
    method = method_named(name)
    steps = LATE.get(name, STEPS[method.order])
    coarse, fine = swaying.error(method, steps), swaying.error(method, 2 * steps)
    assert abs(np.log2(coarse / fine) - method.order) <= 0.2


@pytest.mark.parametrize(
    'name',
    [
        'multiplier_rk4',
        'generalized_alpha',
        'rk4',
        'implicit_midpoint',
        'tr_bdf2',
        'exact_foh',
    ],
)
def test_order_on_a_chain(name, swaying_chain):
    method = method_named(name)
    steps = 2 * STEPS[method.order] if method.order == 4 else STEPS[method.order]
    coarse, fine = swaying_chain.error(method, steps), swaying_chain.error(method, 2 * steps)
    assert abs(np.log2(coarse / fine) - method.order) <= 0.2


@pytest.mark.parametrize('name', METHODS)
def test_every_method_declares_itself(name):
    kind = METHODS[name]
    assert kind.form in ('minimal', 'multiplier')
    assert kind.notes
    assert kind.source
    assert all(0 <= node <= 1 for node in kind.nodes)


@pytest.mark.parametrize('name', METHODS)
def test_no_wind_keeps_rest(name, swaying):
    method, chain = method_named(name), swaying.chain
    calm = np.zeros((len(method.nodes), 1, 2))
    state = method.start(chain, np.zeros(1), np.zeros(1), calm[0], 1 / 60)
    for _ in range(30):
        type(method).kernel(chain.table, state, calm, 1 / 60, method.options(chain, 1 / 60))
    assert abs(method.angles(state)[0]) < 1e-14
