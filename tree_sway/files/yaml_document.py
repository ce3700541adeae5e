# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
YAML, checked against a JSON schema, with the line of each value for the errors.

PyYAML composes the nodes and jsonschema checks their values with the schema that users' editors
read. Before that, a pass over the events refuses anchors, tags and depth, by which a small file
could use up the memory. A ``oneOf`` of required keys is checked by the reader, whose message is
clearer.
"""

from __future__ import annotations

from importlib.resources import files
import json
from pathlib import Path
import re
from typing import Any, NamedTuple

import yaml

from tree_sway.errors import FormatError, nearest  # noqa: I100
from tree_sway.files.text_file import finite
from tree_sway.tables import table_beside

Schema = dict[str, Any]
YAML_SUFFIXES = ('.yaml', '.yml', '.json')

# The C parser, where PyYAML was built with it, is ten times faster.
_LOADER: Any = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
_MAX_DEPTH = 16
_MAX_EVENTS = 600_000
_TYPES = {'mapping': 'object', 'sequence': 'array', 'scalar': 'number'}
_WORDS = {each['key']: each['words'] for each in table_beside(__file__, 'schema_words.csv')}
"""What types and limits of a schema are called."""


def packaged_schema(name: str) -> Schema:
    """Return a JSON schema of the package by its name."""
    resource = files('tree_sway.files.trees.yaml').joinpath(name)
    schema: Schema = json.loads(resource.read_text(encoding='utf-8'))
    return schema


def begins_with_key(path: Path, head: str, key: str) -> bool:
    """Whether a file is named as YAML and its beginning has an outermost key."""
    pattern = rf"""^\{{?\s*["']?{key}["']?\s*:"""
    is_yaml = path.suffix.lower() in YAML_SUFFIXES
    return is_yaml and re.search(pattern, head, re.MULTILINE) is not None


def tree_schema() -> Schema:
    """Return the JSON schema of the YAML form of a tree."""
    return packaged_schema('tree_schema.json')


class YamlDocument(NamedTuple):
    """Checked values of a YAML text: numbers where the schema has them, else texts."""

    values: dict[str, Any]
    source: str
    root: Any
    schema: Schema

    def where(self, *path: str | int) -> str:
        """File and line of the value at a path of keys and positions."""
        return f'{self.source}:{_node_at(self.root, path).start_mark.line + 1}'


def read_yaml(
    text: str, source: str, schema: Schema, expected: str = 'a tree or a forest'
) -> YamlDocument:
    """
    Read the one document of a YAML text; ``expected`` is what an empty one should describe.

    Raises
    ------
    FormatError
        Not YAML, empty, more than one document, an anchor, a tag, a key that occurs twice or is
        not a text, nested too deep, or the first violation of the schema; with ``source:line``.

    """
    try:
        _refuse_unsafe(text, source)
        root = yaml.compose(text, Loader=_LOADER)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        where = f'{source}:{mark.line + 1}' if mark is not None else source
        raise FormatError(f'not YAML: {error.problem}', where=where, cure='correct it') from None
    except yaml.YAMLError as error:
        raise FormatError(
            f'not YAML: {str(error).splitlines()[0]}', where=source, cure='restore it from a copy'
        ) from None
    if root is None:
        what = 'no document' if text.strip() else 'empty'
        raise FormatError(what, where=source, cure=f'describe {expected} in it')
    document = YamlDocument(_value(root, schema, schema, source), source, root, schema)
    _check(document)
    return document


def _refuse_unsafe(text: str, source: str) -> None:
    """Refuse events by which a small file could use up the memory."""
    depth = 0
    event: Any
    for number, event in enumerate(yaml.parse(text, Loader=_LOADER)):
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if getattr(event, 'anchor', None):
            what, cure = 'an anchor or alias', 'write the value itself'
        elif getattr(event, 'tag', None):
            what, cure = f'a tag {event.tag!r}', 'write the value itself'
        elif depth > _MAX_DEPTH:
            what, cure = f'nested deeper than {_MAX_DEPTH}', 'write it flatter'
        elif number > _MAX_EVENTS:
            what, cure = f'more than {_MAX_EVENTS} keys and values', 'give a table of segments'
        else:
            continue
        raise FormatError(what, where=f'{source}:{event.end_mark.line + 1}', cure=cure)


def _value(node: Any, schema: Schema, root: Schema, source: str) -> Any:
    """Plain value of a node, the text itself where the schema has a text."""
    schema = _resolved(schema, root)
    for choice in schema.get('anyOf', ()):
        if _resolved(choice, root)['type'] == _TYPES[node.id]:
            schema = _resolved(choice, root)
    if isinstance(node, yaml.MappingNode):
        known = schema.get('properties', {})
        values = dict[str, Any]()
        for key, child in node.value:
            where = f'{source}:{key.start_mark.line + 1}'
            if not isinstance(key, yaml.ScalarNode):
                what = f'{_WORDS[_TYPES[key.id]]} as a key'
                raise FormatError(what, where=where, cure='use a word as the key')
            if key.value in values:
                first = _node_at(node, [key.value]).start_mark.line + 1
                what = f"key '{key.value}' occurs twice, first in line {first}"
                raise FormatError(what, where=where, cure='remove one of them')
            values[key.value] = _value(child, known.get(key.value, {}), root, source)
        return values
    if isinstance(node, yaml.SequenceNode):
        inside = schema.get('items', {})
        return [_value(child, inside, root, source) for child in node.value]
    if schema.get('type') == 'string' or node.style not in (None, '', 'plain'):
        return node.value
    if node.value in ('true', 'false'):
        return node.value == 'true'
    number = finite(node.value)
    is_whole = number is not None and schema.get('type') == 'integer' and number.is_integer()
    return node.value if number is None else int(number) if is_whole else number


def _resolved(schema: Schema, root: Schema) -> Schema:
    while '$ref' in schema:
        schema = root['$defs'][schema['$ref'].rsplit('/', 1)[1]]
    return schema


def _node_at(node: Any, path: Any) -> Any:
    for step in path:
        if isinstance(step, int):
            node = node.value[step]
        else:
            node = next(child for key, child in node.value if key.value == step)
    return node


def _check(document: YamlDocument) -> None:
    """Raise an error for the first violation of the schema."""
    from jsonschema import Draft202012Validator, validators

    numbers = {'type': 'number'}

    def items(validator: Any, inside: Schema, values: Any, whole: Schema) -> Any:
        """Check items; lists of numbers, of which a tree has thousands, are checked at once."""
        are_floats = isinstance(values, list) and all(type(value) is float for value in values)
        if inside != numbers or not are_floats:
            yield from Draft202012Validator.VALIDATORS['items'](validator, inside, values, whole)

    known = {**Draft202012Validator.VALIDATORS, 'items': items, 'oneOf': lambda *_: ()}
    validator = validators.create(Draft202012Validator.META_SCHEMA, known)(document.schema)
    errors = [_error(document, each) for each in validator.iter_errors(document.values)]
    if errors:
        raise min(errors, key=lambda error: int(error.where.rsplit(':', 1)[1]))


def _error(document: YamlDocument, error: Any) -> FormatError:
    """Convert an error of jsonschema to ours."""
    if error.validator == 'anyOf':
        inside = [each for each in error.context if each.path or each.validator != 'type']
        if inside:
            return _error(document, inside[0])
    path = list(error.absolute_path)
    name = error.json_path.removeprefix('$').lstrip('.') or 'the file'
    if error.validator == 'additionalProperties':
        known = error.schema['properties']
        key = next(key for key in error.instance if key not in known)
        path.append(key)
        what = f"unknown key '{key}' in {name}"
        cure = nearest(key, known) or f'known are {", ".join(known)}'
    elif error.validator == 'required':
        key = next(key for key in error.validator_value if key not in error.instance)
        what = f"{name} has no '{key}'"
        meaning = error.schema.get('properties', {}).get(key, {}).get('description')
        cure = f"add '{key}'" + f': {meaning}' * bool(meaning)
    else:
        node = _node_at(document.root, path)
        cure = _wanted(error.schema, document.schema)
        what = f'{name} is {_WORDS[_TYPES[node.id]]} of {len(node.value)}'
        if isinstance(node, yaml.ScalarNode):
            what = f"{name} is '{node.value[:40]}'"
            cure += ', finite, without quotes or unit' * ('number' in cure)
        cure = f'give {cure}'
    return FormatError(what, where=document.where(*path), cure=cure)


def _wanted(schema: Schema, root: Schema) -> str:
    """Describe the values that a schema allows."""
    if 'anyOf' in schema:
        return ' or '.join(_wanted(_resolved(each, root), root) for each in schema['anyOf'])
    limits = [f'{word} {schema[key]}' for key, word in _WORDS.items() if key in schema]
    return _WORDS[schema['type']] + (' of ' if limits else '') + ' and '.join(limits)
