# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the page says of sensors on the real tree, by the texts of its first language."""

from __future__ import annotations

from functools import cache
import json
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.page.sensors_told import sensors_told  # noqa: E402
from tree_sway.twin import LearnedTree, SwayChange  # noqa: E402
from tree_sway.twin.sway_watch import BandChange  # noqa: E402

WORDS = Path(__file__).parents[2] / 'tree_sway' / 'page' / 'static' / 'words.json'
PHONE = {
    'name': 'phyphox at 3.2', 'in_use': True, 'problem': '', 'rate': 99.6, 'residual': 0.251,
    'notes': [],
}  # fmt: skip
FOLLOWED = 'phyphox at 3.2: followed, 100 Hz, residual 0.25'
LEARNED = LearnedTree(0.6627, 0.9, 0.1, 1.2, 0.1, 0.9, 0.1, 0.447)


@cache
def words() -> dict[str, list[str]]:
    """Return the texts of the page, in each language."""
    return dict(json.loads(WORDS.read_text(encoding='utf-8')))


@pytest.mark.parametrize(
    ('sensors', 'told', 'text'),
    [
        ([], {}, 'Sensors: not on this tree'),
        ([{**PHONE, 'notes': ['acceleration in g']},
          {**PHONE, 'name': 'limb at b12:0.5', 'in_use': False, 'problem': 'silent for 7 s'}],
         {'explained': 0.624},
         f'{FOLLOWED}; acceleration in g\n'
         'limb at b12:0.5: silent for 7 s\nMotion: 62 % by the wind alone, 38 % by sensors'),
        ([PHONE], {'learned': LEARNED, 'band': [-0.0123, 0.02]},
         f'{FOLLOWED}\n'
         'Highest tip: -1.2 to +2.0 cm from this for 80 % of trees that yours may be\n'
         'First frequency 0.663 Hz, learned in 0.45 h of sway'),
        ([PHONE], {'change': SwayChange(1.0764, 0.005, 1.33)},
         f'{FOLLOWED}\nSways differently: frequencies +7.6 % from those of 1.3 h; a limb lost, '
         'loose roots, ice or leaves?'),
        ([PHONE], {'change': SwayChange(1.002, 0.005, 1.0, BandChange(2.53, 2.71, 3.26, 99.0))},
         f'{FOLLOWED}\nSways differently: 2.5 times the power at 2.71 to 3.26 Hz of 1.0 h before; '
         'a limb lost, loose roots, ice or leaves?'),
        ([PHONE], {'change': SwayChange(0.9938, 0.005, 0.5)},
         f'{FOLLOWED}\nSways as before: frequencies -0.6 % from those of 0.5 h'),
        ([{**PHONE, 'in_use': False, 'problem': 'phyphox at 3.2: no sample yet'}],
         {'explained': 1.0}, 'phyphox at 3.2: no sample yet'),
    ],
)  # fmt: skip
def test_sentences_name_the_sensors_and_what_they_tell(sensors: Any, told: Any, text: str) -> None:
    said = [
        words().get(key, [key])[0].format(*values)
        for key, *values in sensors_told(sensors, **told)
    ]
    assert '\n'.join(said) == text


def test_what_is_long_or_of_many_is_cut() -> None:
    long = {**PHONE, 'notes': ['x' * 500]}
    said = list(sensors_told([long] * 20))
    assert len(said) == 8
    assert len(said[0][-1]) == 200
