# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
For whom a parameter was meant: given to this node by its name, or to every node of a launch.

A launch file's ``SetParameter`` and a section ``/**`` of a parameter file reach nodes that know
nothing of the name, or take it for something else. ROS merges all before a node can look, so the
command line is read here once more.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import yaml

_SHARED = ('*', '**')


def own_names(arguments: Sequence[str], node: str) -> frozenset[str]:
    """
    Names of parameters that a command line (`sys.argv`) gives a node by the node's own name.

    ``-p name:=value`` counts where it was typed for this one process; a launch file, which names
    the node it starts by ``__node:=``, may have put it there for every node.
    """
    given = list(_ros_arguments(arguments))
    is_launched = any(value.startswith('__node:=') for flag, value in given if flag in _REMAP)
    names: set[str] = set()
    for flag, value in given:
        if flag in _PARAMETER:
            target, _, name = value.partition(':=')[0].rpartition(':')
            if target == node or (not target and not is_launched):
                names.add(name)
        elif flag == '--params-file':
            names |= _own_of_file(Path(value), node)
    return frozenset(names)


_PARAMETER, _REMAP = ('-p', '--param'), ('-r', '--remap')
_FLAGS = (*_PARAMETER, *_REMAP, '--params-file')


def _ros_arguments(arguments: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Return the flags that take a value, with it, between ``--ros-args`` and ``--``."""
    is_ros, rest = False, iter(arguments)
    for argument in rest:
        if argument in ('--ros-args', '--'):
            is_ros = argument == '--ros-args'
        elif is_ros and argument in _FLAGS:
            yield argument, next(rest, '')


def _own_of_file(path: Path, node: str) -> set[str]:
    try:
        content = yaml.safe_load(path.read_text(encoding='utf-8'))
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return set()  # ROS has read it or refused it by now
    return set(_own_of_sections(content, node)) if isinstance(content, dict) else set()


def _own_of_sections(sections: dict[Any, Any], node: str) -> Iterator[str]:
    for key, body in sections.items():
        if not isinstance(body, dict):
            continue
        last = str(key).rsplit('/', 1)[-1]
        if 'ros__parameters' not in body:
            yield from _own_of_sections(body, node)  # a namespace
        elif last == node and last not in _SHARED:
            yield from _flat(body['ros__parameters'] or {}, '')


def _flat(values: dict[Any, Any], before: str) -> Iterator[str]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f'{before}{key}.')
        else:
            yield f'{before}{key}'
