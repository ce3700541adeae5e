# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files to trees, winds and motions, and back.

Each wing has a face of its own: `trees`, `scenes` (lists and inventories), `wind`, `motion`,
`models` (prepared ones), `recording` (bags) and `export`. What they share is here: text in any
encoding, tables of any separator, names and units of columns, times as people write them, YAML
checked against schemas, and writing that leaves the old file until the new one is whole. A reader
refuses what it does not understand, with file, line and cure; it never guesses in silence.

A format is one module with a sniffer and a reader, found by its registry. Here is no arithmetic of
motion.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.atomic_file import refuse_unwritable as refuse_unwritable
    from tree_sway.files.atomic_file import whole_file as whole_file
    from tree_sway.files.atomic_file import write_text_whole as write_text_whole
    from tree_sway.files.column_names import folded as folded
    from tree_sway.files.column_names import motion_of as motion_of
    from tree_sway.files.column_names import rank_of as rank_of
    from tree_sway.files.column_names import SENDERS as SENDERS
    from tree_sway.files.column_names import unit_factor as unit_factor
    from tree_sway.files.column_names import unit_in_name as unit_in_name
    from tree_sway.files.json_values import list_of as list_of
    from tree_sway.files.json_values import object_of as object_of
    from tree_sway.files.layouts.monitor import pairs_of as pairs_of
    from tree_sway.files.paths import is_file as is_file
    from tree_sway.files.paths import path_of as path_of
    from tree_sway.files.reading_options import reader_options as reader_options
    from tree_sway.files.table_file import parse_table as parse_table
    from tree_sway.files.text_file import finite as finite
    from tree_sway.files.text_file import read_bytes as read_bytes
    from tree_sway.files.text_file import read_head as read_head
    from tree_sway.files.text_file import read_lines as read_lines
    from tree_sway.files.text_file import read_text as read_text
    from tree_sway.files.time_stamps import dates as dates
    from tree_sway.files.yaml_document import packaged_schema as packaged_schema
    from tree_sway.files.yaml_document import read_yaml as read_yaml
    from tree_sway.files.yaml_document import YamlDocument as YamlDocument
else:
    __getattr__, __dir__, __all__ = face(__name__)
