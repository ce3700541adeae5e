# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a calibration refuses before it begins."""

from __future__ import annotations

import pytest

from tree_sway.errors import ParameterError
from tree_sway.identification.calibration import calibrate


@pytest.mark.parametrize('frequency', ['3', None, b'3', [1.0], {}, 1j], ids=repr)
def test_a_frequency_that_is_no_number_is_named(fork, frequency):
    with pytest.raises(ParameterError, match='is not a number'):
        calibrate(fork(), None, frequency)


def test_a_branch_that_is_no_name_is_refused(fork):
    with pytest.raises(ParameterError):
        calibrate(fork(), None, 1.0, branch=3)
