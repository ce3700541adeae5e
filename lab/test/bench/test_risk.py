# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The city whose critical winds are timed, and one tree of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from tree_sway_lab.bench.risk import time_risk, write_city

from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import inventory_of
from tree_sway.files.text_file import read_head


def test_all_trees_of_the_city_are_read_and_all_species_known(tmp_path: Path) -> None:
    path = tmp_path / 'city.csv'
    write_city(path, 2000)
    inventory = inventory_of(inventory_table(path, read_head(path)), needs_place=True)
    assert len(inventory.names) == 2000
    assert not any('not in the table' in note for note in inventory.notes)
    assert (inventory.height.min(), inventory.height.max()) == pytest.approx((4.5, 26.5), abs=1.5)
    assert not any(inventory.is_height_found)


@pytest.mark.long
def test_a_tree_takes_seconds_and_memory() -> None:
    pytest.importorskip('distributed', reason='needs dask.distributed')
    seconds, cpu_seconds, memory = time_risk([1])
    assert seconds.value > 0.1
    assert cpu_seconds.value > 0.1
    assert memory.value > 100.0
