# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import fields

from jsonschema import Draft202012Validator
import pytest

from tree_sway.core.species.species import Species
from tree_sway.errors import FormatError
from tree_sway.files.yaml_document import read_yaml, tree_schema


def schemas(schema):
    """Every schema inside a schema."""
    yield schema
    for inner in (*schema.get('properties', {}).values(), *schema.get('$defs', {}).values(),
                  *schema.get('anyOf', ()), *filter(None, [schema.get('items')])):  # fmt: skip
        yield from schemas(inner)


ENFORCED = {
    'type', 'properties', 'required', 'additionalProperties', 'items', 'minItems', 'maxItems',
    'minimum', 'maximum', 'exclusiveMinimum', 'minLength', 'maxLength', 'anyOf', '$ref', '$defs',
    '$schema', 'title', 'description', 'oneOf',
}  # fmt: skip


def test_schema_says_nothing_that_is_not_enforced():
    for schema in schemas(tree_schema()):
        assert set(schema) <= ENFORCED
        if schema.get('type') == 'object':
            assert schema['additionalProperties'] is False


def test_wood_is_what_a_species_has():
    keys = set(tree_schema()['$defs']['wood']['properties']) - {'damping_ratio'}
    assert keys <= {field.name for field in fields(Species)}
    assert {'modulus', 'density', 'damping_bare', 'damping_in_leaf'} <= keys


def test_references_exist():
    root = tree_schema()
    for schema in schemas(root):
        if '$ref' in schema:
            assert schema['$ref'].removeprefix('#/$defs/') in root['$defs']


def test_another_validator_agrees():
    Draft202012Validator.check_schema(tree_schema())


SCHEMA = {
    'type': 'object',
    'additionalProperties': False,
    'properties': {
        'name': {'type': 'string', 'minLength': 1},
        'width': {'anyOf': [{'type': 'number'}, {'type': 'array', 'items': {'type': 'number'}}]},
        'count': {'type': 'integer'},
        'is_bare': {'type': 'boolean'},
    },
}


@pytest.mark.parametrize(
    ('text', 'values'),
    [
        ('width: 1', {'width': 1.0}),
        ('width: -.5e-3', {'width': -0.5e-3}),
        ('width: [1, 2]', {'width': [1.0, 2.0]}),
        ('{name: 12, count: 3.0, is_bare: true}', {'name': '12', 'count': 3, 'is_bare': True}),
        ("name: 'true'", {'name': 'true'}),
    ],
)
def test_values(text, values):
    document = read_yaml(text, 't', SCHEMA)
    assert document.values == values
    assert [type(value) for value in document.values.values()] == [*map(type, values.values())]


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('width: [1, x]', r"t:1: width\[1\] is 'x'; give a number, finite, without"),
        ('width: {}', 't:1: width is a mapping of 0; give a number or a list'),
        ('name: a\n\ncount: 1.5', "t:3: count is '1.5'; give a whole number"),
        ("is_bare: yes\nname: ''\n", "t:1: is_bare is 'yes'; give true or false"),
        ("name: ''", "t:1: name is ''; give a text"),
        (
            "count: '3'",
            "t:1: count is '3'; give a whole number, finite, without quotes",
        ),
        ('# nothing', 't: no document'),
        ('name: *a', 't:1: an anchor or alias; write the value itself'),
    ],
)
def test_errors(text, message):
    with pytest.raises(FormatError, match=message):
        read_yaml(text, 't', SCHEMA)


def test_a_place_has_its_line():
    document = read_yaml('name: a\nwidth:\n- 1\n- 2\n', 't', SCHEMA)
    assert [document.where(), document.where('width'), document.where('width', 1)] == [
        't:1',
        't:3',
        't:4',
    ]
