# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Methods by name."""

from __future__ import annotations

import pytest
from tree_sway_lab.methods.registry import method_named

from tree_sway.errors import ParameterError


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(ParameterError, match="unknown integrator 'euler'"):
        method_named('euler')
