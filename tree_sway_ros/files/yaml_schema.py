"""
Check YAML nodes against the published schema, and turn them into plain values.

The schema that users' editors read is the one that is enforced here, so that the two cannot drift.
The part of JSON Schema 2020-12 in use: type, properties, required, additionalProperties, items,
minItems, maxItems, minimum, maximum, exclusiveMinimum, minLength, anyOf, $ref. A ``oneOf`` of
required keys is left to the reader, which can say it better.

"""

from __future__ import annotations

import difflib
import json
from collections.abc import Callable
from importlib.resources import files
from typing import Any

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.text_file import finite
from tree_sway_ros.files.yaml_nodes import YamlNode

Schema = dict[str, Any]

_KINDS = {"object": "a mapping", "array": "a list", "string": "a text", "number": "a number",
          "integer": "a whole number", "boolean": "true or false"}  # fmt: skip


def packaged_schema(name: str) -> Schema:
    """Return a JSON schema that stands beside this file."""
    resource = files("tree_sway_ros.files.trees.yaml").joinpath(name)
    schema: Schema = json.loads(resource.read_text(encoding="utf-8"))
    return schema


def tree_schema() -> Schema:
    """Return the JSON schema of the YAML form of a tree."""
    return packaged_schema("tree_schema.json")


class SchemaCheck:
    """
    Checks nodes of one file.

    Parameters
    ----------
    schema
        The schema, whose ``$defs`` references point into.
    source
        The file, for the errors.

    """

    def __init__(self, schema: Schema, source: str) -> None:
        self._root = schema
        self._source = source
        self._readers: dict[str, Callable[[YamlNode, Schema, str], Any]] = {
            "object": self._mapping,
            "array": self._list,
            "string": self._text,
            "number": self._number,
            "integer": self._number,
            "boolean": self._truth,
        }

    def value(self, node: YamlNode, schema: Schema | None = None, name: str = "the file") -> Any:
        """
        Return the plain value of a node.

        Raises
        ------
        FormatError
            At the first thing that the schema does not allow, with ``file:line``.

        """
        schema = self._root if schema is None else schema
        while "$ref" in schema:
            schema = self._root["$defs"][schema["$ref"].rsplit("/", 1)[1]]
        if "anyOf" in schema:
            schema = self._alternative(node, schema["anyOf"], name)
        return self._readers[schema["type"]](node, schema, name)

    def _error(self, node: YamlNode, what: str, cure: str) -> FormatError:
        return FormatError(what, where=f"{self._source}:{node.line}", cure=cure)

    def _alternative(self, node: YamlNode, choices: list[Schema], name: str) -> Schema:
        wanted = []
        for choice in choices:
            resolved = choice
            while "$ref" in resolved:
                resolved = self._root["$defs"][resolved["$ref"].rsplit("/", 1)[1]]
            if isinstance(node.value, _TYPES[resolved["type"]]):
                return resolved
            wanted.append(_KINDS[resolved["type"]])
        raise self._error(node, f"{name} is {node.kind}", f"give {' or '.join(wanted)}")

    def _mapping(self, node: YamlNode, schema: Schema, name: str) -> dict[str, Any]:
        entries = node.value
        if not isinstance(entries, dict):
            raise self._error(node, f"{name} is {node.kind}", "give a mapping of keys to values")
        known = schema["properties"]
        for key, child in entries.items():
            if key not in known:
                close = difflib.get_close_matches(key, known, n=1)
                cure = f"did you mean '{close[0]}'?" if close else f"known are {', '.join(known)}"
                raise self._error(child, f"unknown key '{key}' in {name}", cure)
        for key in schema.get("required", ()):
            if key not in entries:
                raise self._error(node, f"{name} has no '{key}'", f"add '{key}'")
        return {
            key: self.value(child, known[key], _inside(name, key)) for key, child in entries.items()
        }

    def _list(self, node: YamlNode, schema: Schema, name: str) -> list[Any]:
        items = node.value
        if not isinstance(items, list):
            raise self._error(node, f"{name} is {node.kind}", "give a list")
        least, most = schema.get("minItems", 0), schema.get("maxItems")
        if len(items) < least or (most is not None and len(items) > most):
            wanted = f"{least}" if least == most else f"at least {least}"
            raise self._error(node, f"{name} has {len(items)} items", f"give {wanted}")
        return [self.value(item, schema["items"], f"{name}[{i}]") for i, item in enumerate(items)]

    def _text(self, node: YamlNode, schema: Schema, name: str) -> str:
        if not isinstance(node.value, str):
            raise self._error(node, f"{name} is {node.kind}", "give a text")
        if len(node.value) < schema.get("minLength", 0):
            raise self._error(node, f"{name} is empty", "give a text")
        return node.value

    def _truth(self, node: YamlNode, schema: Schema, name: str) -> bool:
        if node.is_plain and node.value in ("true", "false"):
            return node.value == "true"
        found = f"'{node.value[:40]}'" if isinstance(node.value, str) else node.kind
        raise self._error(node, f"{name} is {found}", f"give {_KINDS['boolean']}")

    def _number(self, node: YamlNode, schema: Schema, name: str) -> float | int:
        kind = _KINDS[schema["type"]]
        if not isinstance(node.value, str):
            raise self._error(node, f"{name} is {node.kind}", f"give {kind}")
        number = finite(node.value) if node.is_plain else None
        if number is None or (schema["type"] == "integer" and not number.is_integer()):
            cure = (
                f"give {'a finite number' if kind == 'a number' else kind} without quotes or unit"
            )
            raise self._error(node, f"{name} is '{node.value[:40]}', not {kind}", cure)
        low, high = schema.get("minimum"), schema.get("maximum")
        above = schema.get("exclusiveMinimum")
        if above is not None and number <= above:
            raise self._error(node, f"{name} is {number:g}", f"give more than {above}")
        if (low is not None and number < low) or (high is not None and number > high):
            wanted = f"from {low} to {high}" if high is not None else f"of at least {low}"
            raise self._error(node, f"{name} is {number:g}", f"give {kind} {wanted}")
        return int(number) if schema["type"] == "integer" else number


_TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "number": str,
    "integer": str,
    "boolean": str,
}


def _inside(name: str, key: str) -> str:
    return key if name == "the file" else f"{name}.{key}"
