from dataclasses import fields

import pytest

from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.files.yaml_nodes import parse_yaml
from tree_sway_ros.files.yaml_schema import SchemaCheck, tree_schema


def schemas(schema):
    """Every schema inside a schema."""
    yield schema
    for inner in (*schema.get("properties", {}).values(), *schema.get("$defs", {}).values(),
                  *schema.get("anyOf", ()), *filter(None, [schema.get("items")])):  # fmt: skip
        yield from schemas(inner)


ENFORCED = {
    "type", "properties", "required", "additionalProperties", "items", "minItems", "maxItems",
    "minimum", "maximum", "exclusiveMinimum", "minLength", "anyOf", "$ref", "$defs", "$schema",
    "title", "description", "oneOf",
}  # fmt: skip


def test_schema_says_nothing_that_is_not_enforced():
    for schema in schemas(tree_schema()):
        assert set(schema) <= ENFORCED
        if schema.get("type") == "object":
            assert schema["additionalProperties"] is False


def test_wood_is_what_a_species_has():
    keys = set(tree_schema()["$defs"]["wood"]["properties"]) - {"damping_ratio"}
    assert keys <= {field.name for field in fields(Species)}
    assert {"modulus", "density", "damping_bare", "damping_in_leaf"} <= keys


def test_references_exist():
    root = tree_schema()
    for schema in schemas(root):
        if "$ref" in schema:
            assert schema["$ref"].removeprefix("#/$defs/") in root["$defs"]


def test_another_validator_agrees():
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed")
    jsonschema.Draft202012Validator.check_schema(tree_schema())


@pytest.mark.parametrize(
    ("text", "value"), [("1", 1.0), ("-.5e-3", -0.5e-3), ("[1, 2]", [1.0, 2.0])]
)
def test_number_or_pair(text, value):
    node = parse_yaml(text, "t")
    assert SchemaCheck(tree_schema(), "t").value(node, tree_schema()["$defs"]["diameter"]) == value
