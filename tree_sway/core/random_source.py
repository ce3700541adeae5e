# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A source of random numbers as callers give it: a generator, or a seed."""

from __future__ import annotations

import numpy as np

from tree_sway.errors import ParameterError


def generator_of(rng: object) -> np.random.Generator:
    """
    Return a generator of random numbers: one as it is, or that of a seed.

    A `ParameterError` refuses anything else, so that no result is random by mistake.
    """
    if isinstance(rng, np.random.Generator):
        return rng
    if isinstance(rng, int | np.integer) and not isinstance(rng, bool) and rng >= 0:
        return np.random.default_rng(int(rng))
    cure = 'give numpy.random.default_rng(5), or the seed alone: 5'
    raise ParameterError(f'{rng!r} is no source of random numbers', where='rng', cure=cure)
