# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a study file to its cases: every tree in every wind with every combination of settings.

A case is plain data, so that any process on any machine can compute it, and has a name that
follows from all its input: its values, the content of its files, and the source of the simulator.

"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
import hashlib
from importlib.resources import files
import itertools
import json
from pathlib import Path
from typing import Any

from tree_sway.core.simulator.settings import Settings
from tree_sway.errors import FormatError, nearest, ParameterError
from tree_sway.files.text_file import path_of, read_bytes, read_text
from tree_sway.files.yaml_document import read_yaml
from tree_sway.kernel_cache import ROOT, source_digest

Plain = dict[str, Any]

_ARRAYS = {'leaf_mass', 'leaf_area', 'profile'}
"""Settings that a study does not vary."""

_ROOMS = 'core', 'files', 'studies'
"""Rooms whose source and tables determine the results."""


@dataclass(frozen=True)
class Case:
    """
    One tree in one wind with one set of settings.

    Parameters
    ----------
    tree
        ``{"name": ...}``, ``{"file": path}`` or ``{"species", "height", "seed"}``.
    wind
        ``{"file": path, "scale"}`` or ``{"speed", "intensity", "seed"}``.
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
        A file that cannot be read, is not YAML, or does not match the schema.
    ParameterError
        An unknown setting, or a wrong value.

    """
    path = path_of(path)
    schema = json.loads(
        files('tree_sway.studies').joinpath('study_schema.json').read_text('utf-8')
    )
    document = read_yaml(read_text(path), str(path), schema)
    study = document.values
    for number, wind in enumerate(study['winds']):
        if ('file' in wind) == ('speed' in wind):
            where = document.where('winds', number)
            raise FormatError('a wind is a file or a speed', where=where, cure='give one of them')
    varied = _settings(study.get('settings', {}), path)
    common = {key: study[key] for key in ('seconds', 'rate') if key in study}
    code = ''.join(source_digest(ROOT / room) for room in _ROOMS).encode()
    cases = []
    for tree, wind, settings in itertools.product(
        _trees(study['trees'], path.parent), _winds(study['winds'], path.parent), varied
    ):
        read = [Path(part['file']) for part in (tree, wind) if 'file' in part]
        digest = hashlib.blake2b(code, digest_size=10)
        for each in read:
            digest.update(read_bytes(each))
        cases.append(Case(tree, wind, settings, **common, digest=digest.hexdigest()))
    return cases


def _trees(entries: list[Any], folder: Path) -> list[Plain]:
    found: list[Plain] = []
    for entry in entries:
        if isinstance(entry, str):
            beside = folder / Path(entry).expanduser()
            found.append({'file': str(beside)} if beside.is_file() else {'name': entry})
        else:
            grow = entry['grow']
            rows = itertools.product(
                _listed(grow['species']), _listed(grow['height']), range(grow.get('seeds', 1))
            )
            found += [{'species': s, 'height': float(h), 'seed': k} for s, h, k in rows]
    return found


def _winds(entries: list[Plain], folder: Path) -> list[Plain]:
    found: list[Plain] = []
    for entry in entries:
        if 'file' in entry:
            path = str(folder / Path(entry['file']).expanduser())
            found += [{'file': path, 'scale': float(s)} for s in _listed(entry.get('scale', 1.0))]
        else:
            rows = itertools.product(
                _listed(entry['speed']), _listed(entry.get('intensity', 0.2)),
                range(entry.get('seeds', 1)),
            )  # fmt: skip
            found += [{'speed': float(u), 'intensity': float(i), 'seed': k} for u, i, k in rows]
    return found


def _settings(varied: Plain, path: Path) -> list[Plain]:
    known = {field.name for field in fields(Settings)} - _ARRAYS
    unknown = sorted(set(varied) - known)
    if unknown:
        raise ParameterError(
            f"no setting is called '{unknown[0]}'",
            where=f'{path}: settings',
            cure=nearest(unknown[0], known) or f'use one of: {", ".join(sorted(known))}',
        )
    combinations = itertools.product(*map(_listed, varied.values()))
    found = [dict(zip(varied, values, strict=True)) for values in combinations]
    for each in found:
        try:
            Settings(**each)
        except TypeError as error:
            where = f'{path}: settings'
            raise ParameterError(f'{each}: {error}', where=where, cure='give numbers') from None
    return found


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]
