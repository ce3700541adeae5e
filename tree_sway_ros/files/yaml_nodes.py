"""
YAML text as nodes that know their line.

PyYAML's event parser, put together here rather than by its constructor: each value keeps its line
for the errors, a key that stands twice is refused and not silently overwritten, an anchor cannot
blow a small file up, and depth has a bound.

"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from tree_sway_ros.errors import FormatError

# The C parser, where PyYAML was built with it, is ten times faster.
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_NODE_EVENTS = frozenset(
    (yaml.ScalarEvent, yaml.SequenceStartEvent, yaml.MappingStartEvent, yaml.AliasEvent)
)
_MAX_DEPTH = 16


@dataclass(slots=True)
class YamlNode:
    """
    One value of a YAML file.

    Parameters
    ----------
    value
        Text of a scalar, items of a list, or entries of a mapping.
    line
        Its line in the file, from 1.
    is_plain
        True for a scalar without quotes, which may be a number.

    """

    value: str | list[YamlNode] | dict[str, YamlNode]
    line: int
    is_plain: bool = False

    @property
    def kind(self) -> str:
        """Its kind in the words of the error messages."""
        return {str: "a text", list: "a list", dict: "a mapping"}[type(self.value)]


@dataclass(slots=True)
class _Open:
    """A list or mapping that the parser is inside of."""

    node: YamlNode
    key: str | None = None


def parse_yaml(text: str, source: str) -> YamlNode:
    """
    Parse the one document of a YAML text.

    Raises
    ------
    FormatError
        Not YAML, empty, more than one document, an alias, a tag, a key that stands twice or is no
        text, or nested too deep; with ``source:line``.

    """
    if not text.strip():
        raise FormatError("empty", where=source, cure="describe a tree or a forest in it")
    try:
        return _compose(text, source)
    except yaml.MarkedYAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"{source}:{mark.line + 1}" if mark is not None else source
        raise FormatError(f"not YAML: {error.problem}", where=where, cure="mend it") from None
    except yaml.YAMLError as error:
        raise FormatError(f"not YAML: {str(error).splitlines()[0]}", where=source) from None


def _compose(text: str, source: str) -> YamlNode:
    root: YamlNode | None = None
    stack: list[_Open] = []
    events: Iterator[Any] = yaml.parse(text, Loader=_LOADER)
    for event in events:
        kind = type(event)
        if kind is yaml.SequenceEndEvent or kind is yaml.MappingEndEvent:
            stack.pop()
            continue
        if kind not in _NODE_EVENTS:
            continue
        line = event.start_mark.line + 1
        if event.anchor is not None or getattr(event, "tag", None) is not None:
            what = f"a tag {event.tag!r}" if event.anchor is None else "an anchor or alias"
            raise FormatError(what, where=f"{source}:{line}", cure="write the value itself")
        if kind is yaml.ScalarEvent:
            node = YamlNode(event.value, line, is_plain=event.style in (None, "", "plain"))
        else:
            node = YamlNode([] if kind is yaml.SequenceStartEvent else {}, line)
        if stack:
            _put(stack[-1], node, source)
        elif root is None:
            root = node
        else:
            raise FormatError(
                "a second document", where=f"{source}:{line}", cure="keep one document a file"
            )
        if kind is not yaml.ScalarEvent:
            if len(stack) >= _MAX_DEPTH:
                raise FormatError(f"nested deeper than {_MAX_DEPTH}", where=f"{source}:{line}")
            stack.append(_Open(node))
    if root is None:
        raise FormatError("no document", where=source, cure="describe a tree or a forest in it")
    return root


def _put(opened: _Open, node: YamlNode, source: str) -> None:
    """Put a node into the list or mapping that is open, as an item, a key or its value."""
    container = opened.node.value
    if isinstance(container, list):
        container.append(node)
        return
    assert isinstance(container, dict)
    if opened.key is not None:
        container[opened.key] = node
        opened.key = None
        return
    if not isinstance(node.value, str):
        raise FormatError(
            f"{node.kind} as a key", where=f"{source}:{node.line}", cure="use a word as the key"
        )
    if node.value in container:
        raise FormatError(
            f"key '{node.value}' stands twice, first in line {container[node.value].line}",
            where=f"{source}:{node.line}",
            cure="remove one of them",
        )
    opened.key = node.value
