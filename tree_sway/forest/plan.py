# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a study file to its cases: every tree in every wind with every combination of settings.

A case is plain data, so that any process on any machine can compute it, and has a name that
follows from all its input: its values, the content of its files, and the source of the simulator.

"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from functools import cache
import hashlib
from importlib.resources import files
import itertools
import json
import math
from pathlib import Path

from tree_sway.cache import ROOT, source_digest
from tree_sway.core.settings import Settings
from tree_sway.errors import FormatError, inside, nearest, ParameterError
from tree_sway.files import path_of, read_bytes, read_text, read_yaml
from tree_sway.files.scenes import expected
from tree_sway.files.wind import EXAMPLES
from tree_sway.forest.cluster import ROOMS
from tree_sway.forest.entries import listed, Plain, trees_of, winds_of
from tree_sway.simulation import refuse_too_many_steps

_ARRAYS = {'leaf_mass', 'leaf_area', 'profile'}
"""Settings that a study does not vary."""

_MAX_CASES = 100_000
"""Largest number of cases of a study, which are all planned before the first is computed."""


@dataclass(frozen=True)
class Case:
    """
    One tree in one wind with one set of settings.

    Parameters
    ----------
    tree
        ``{"name": ...}``, ``{"file": path}`` or ``{"species", "height", "seed"}``.
    wind
        ``{"file": path, "scale"}``, where a built-in wind has its name for a path, or ``{"speed",
        "intensity", "seed"}``.
    settings
        Fields of `Settings`.
    seconds, rate
        Length in [s] and steps per second [Hz].
    digest
        Digest of its files and of the simulator's source.

    """

    tree: Plain
    wind: Plain
    settings: Plain = field(default_factory=dict)
    seconds: float = 60.0
    rate: float = 60.0
    digest: str = ''

    @property
    def name(self) -> str:
        """Unique name of twenty letters and digits."""
        text = json.dumps(asdict(self), sort_keys=True)
        return hashlib.blake2b(text.encode(), digest_size=10).hexdigest()


def read_study(path: str | Path) -> list[Case]:
    """
    Read a study file.

    Parameters
    ----------
    path
        Path of a YAML file; names of files in it are relative to it.

    Returns
    -------
    list of Case
        Cases in the order of trees, winds, settings.

    Raises
    ------
    FormatError
        A file that cannot be read, is not YAML, does not match the schema, or has more than
        `_MAX_CASES` cases.
    TreeSwayError
        An unknown setting, species or tree, a wrong value, or too many steps of a case.

    """
    path = path_of(path)
    schema = json.loads(files('tree_sway.forest').joinpath('study_schema.json').read_text('utf-8'))
    with expected(path, 'study', 'scene'):
        document = read_yaml(read_text(path), str(path), schema, 'trees and winds')
    study = document.values
    common = {key: study[key] for key in ('seconds', 'rate') if key in study}
    _refuse_large(study, Case({}, {}, **common), str(path))
    trees = trees_of(document, path.parent)
    winds = winds_of(document, path.parent)
    varied = _settings(study.get('settings', {}), path)
    code = ''.join(source_digest(ROOT / room) for room in ROOMS).encode()
    cases = []
    contents = cache(_content)
    for tree, wind, settings in itertools.product(trees, winds, varied):
        digest = hashlib.blake2b(code, digest_size=10)
        for part in (tree, wind):
            digest.update(contents(part.get('file')))
        cases.append(Case(tree, wind, settings, **common, digest=digest.hexdigest()))
    return cases


def _content(file: str | None) -> bytes:
    """Digest of a file; empty for none, and for built-in winds, which are a part of the code."""
    if file is None or file in EXAMPLES:
        return b''
    return hashlib.blake2b(read_bytes(Path(file)), digest_size=20).digest()


def _refuse_large(study: Plain, case: Case, where: str) -> None:
    """Refuse too many cases, or too many steps of one, before any is made."""
    trees = winds = 0
    for entry in study['trees']:
        is_grown = isinstance(entry, dict) and 'grow' in entry
        trees += _count(entry['grow'], 'species', 'height') if is_grown else 1
    for entry in study['winds']:
        winds += _count(entry, 'speed', 'intensity', 'scale')
    settings = math.prod(len(listed(value)) for value in study.get('settings', {}).values())
    count = trees * winds * settings
    if count > _MAX_CASES:
        raise FormatError(
            f'{trees} trees in {winds} winds with {settings} settings are {count} cases',
            where=where,
            cure=f'give at most {_MAX_CASES} cases in a study',
        )
    with inside(where):
        refuse_too_many_steps(case.seconds * case.rate, case.rate)


def _count(entry: Plain, *names: str) -> int:
    """Count the combinations of the values of an entry, with its seeds."""
    lengths = (len(listed(entry[name])) for name in names if name in entry)
    return math.prod(lengths) * int(entry.get('seeds', 1))


def _settings(varied: Plain, path: Path) -> list[Plain]:
    known = {field.name for field in fields(Settings)} - _ARRAYS
    unknown = sorted(set(varied) - known)
    if unknown:
        raise ParameterError(
            f"no setting is called '{unknown[0]}'",
            where=f'{path}: settings',
            cure=nearest(unknown[0], known) or f'use one of: {", ".join(sorted(known))}',
        )
    combinations = itertools.product(*map(listed, varied.values()))
    found = [dict(zip(varied, values, strict=True)) for values in combinations]
    for each in found:
        try:
            Settings(**each)
        except TypeError as error:
            where = f'{path}: settings'
            raise ParameterError(f'{each}: {error}', where=where, cure='give numbers') from None
    return found
