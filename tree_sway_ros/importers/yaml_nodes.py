"""
YAML text as nodes that know their line.

PyYAML's event parser, put together here rather than by its constructor: each value keeps its line for
the errors, a key that stands twice is refused and not silently overwritten, an anchor cannot blow a
small file up, and depth has a bound.

"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import yaml

from tree_sway_ros.errors import FormatError

# The C parser, where PyYAML was built with it, is ten times faster.
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
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
        raise FormatError("empty", where=source, cure="describe a tree in it")
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
    for event in yaml.parse(text, Loader=_LOADER):
        if isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            stack.pop()
            continue
        if not isinstance(event, yaml.NodeEvent):
            continue
        assert event.start_mark is not None
        line = event.start_mark.line + 1
        where = f"{source}:{line}"
        _refuse_references(event, where)
        node = _node(event, line)
        if not stack:
            if root is not None:
                raise FormatError("a second document", where=where, cure="keep one tree a file")
            root = node
        elif isinstance(node.value, str) and stack[-1].key is None and _is_mapping(stack[-1]):
            _take_key(stack[-1], node.value, where)
        else:
            _attach(stack[-1], node, where)
        if not isinstance(node.value, str):
            if len(stack) >= _MAX_DEPTH:
                raise FormatError(f"nested deeper than {_MAX_DEPTH}", where=where)
            stack.append(_Open(node))
    if root is None:
        raise FormatError("no document", where=source, cure="describe a tree in it")
    return root


def _refuse_references(event: yaml.NodeEvent, where: str) -> None:
    if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
        raise FormatError("an anchor or alias", where=where, cure="write the value itself")
    tag = getattr(event, "tag", None)
    if tag is not None:
        raise FormatError(f"a tag {tag!r}", where=where, cure="leave the tag out")


def _node(event: yaml.NodeEvent, line: int) -> YamlNode:
    if isinstance(event, yaml.ScalarEvent):
        return YamlNode(event.value, line, is_plain=event.style in (None, "", "plain"))
    return YamlNode([] if isinstance(event, yaml.SequenceStartEvent) else {}, line)


def _is_mapping(opened: _Open) -> bool:
    return isinstance(opened.node.value, dict)


def _take_key(opened: _Open, key: str, where: str) -> None:
    entries = opened.node.value
    assert isinstance(entries, dict)
    if key in entries:
        raise FormatError(
            f"key '{key}' stands twice, first in line {entries[key].line}",
            where=where,
            cure="remove one of them",
        )
    opened.key = key


def _attach(opened: _Open, node: YamlNode, where: str) -> None:
    container = opened.node.value
    if isinstance(container, list):
        container.append(node)
        return
    assert isinstance(container, dict)
    if opened.key is None:
        raise FormatError(f"{node.kind} as a key", where=where, cure="use a word as the key")
    container[opened.key] = node
    opened.key = None
