# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""For all tests of the laboratory: its commands, also where it is not installed."""

from importlib.metadata import entry_points, EntryPoint

import pytest

from tree_sway.commands import entries

LABORATORY = EntryPoint('lab', 'tree_sway_lab.commands:COMMANDS', entries.GROUP)


@pytest.fixture(scope='session', autouse=True)
def commands_of_this_checkout():
    """Find the commands of the laboratory of this checkout, whose folder is on the path."""
    with pytest.MonkeyPatch.context() as patch:
        own = {entries.GROUP: [LABORATORY]}

        def found(group):
            return [*own.get(group, ()), *entry_points(group=group)]

        patch.setattr(entries, 'entry_points', found)
        yield
