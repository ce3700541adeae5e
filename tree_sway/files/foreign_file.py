# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a file is that none of our readers takes, and what to give instead.

Its suffix tells, or in `foreign_files.csv` how a file ``begins``, as a regular
expression without its spaces.
"""

from __future__ import annotations

from pathlib import Path
import re

from tree_sway.tables import table_beside

_FOREIGN = table_beside(__file__, 'foreign_files.csv')


def foreign_file(path: Path, head: str = '') -> tuple[str, str]:
    """
    Return what a file is and the cure; two empty texts if nothing tells.

    With its ``head``, the beginning of the file tells in place of the suffix.
    """
    if head:
        first = ''.join(head[:400].split())
        found = (each for each in _FOREIGN if each['begins'] and re.match(each['begins'], first))
    else:
        suffix = path.suffix.lower()
        found = (each for each in _FOREIGN if suffix in each['suffixes'].split())
    told = next(found, {'what': '', 'cure': ''})
    return told['what'], told['cure']
