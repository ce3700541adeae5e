# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parts of the package that are installed on request: which module is in which, and how to get it.

No advice is made from the name of a module, which may be that of a different project.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib.metadata import distribution, EntryPoint, PackageNotFoundError
from importlib.util import find_spec
import json
from pathlib import Path
import re
import sys
from typing import Any, NamedTuple
from urllib.parse import unquote, urlparse

from tree_sway.errors import MissingDependencyError


class _Extra(NamedTuple):
    """Extra of the package with a module, the distribution with it, and its least version."""

    name: str
    distribution: str
    least: str


EXTRAS = {
    'PIL': _Extra('plot', 'pillow', '7'),
    'matplotlib': _Extra('plot', 'matplotlib', '3.6'),
    'mpl_toolkits': _Extra('plot', 'matplotlib', '3.6'),
    'cryptography': _Extra('study', 'cryptography', '41'),
    'dask': _Extra('study', 'dask', '2023.1'),
    'distributed': _Extra('study', 'distributed', '2023.1'),
    'rosbags': _Extra('bag', 'rosbags', '0.11'),
    'tqdm': _Extra('progress', 'tqdm', '4.60'),
    'serial': _Extra('sensors', 'pyserial', '3.5'),
    'cv2': _Extra('camera', 'opencv-python-headless', '4.5'),
    'imageio_ffmpeg': _Extra('film', 'imageio-ffmpeg', '0.5'),
    'pyarrow': _Extra('parquet', 'pyarrow', '12'),
    'netCDF4': _Extra('netcdf', 'netCDF4', '1.6'),
    'openpyxl': _Extra('inventory', 'openpyxl', '3.1'),
}
"""Modules that are installed on request; the versions are those of ``setup.py``."""

PACKAGE = 'tree_sway_ros'
"""Name of the distribution."""
_STAMP = 'tree_sway_ros.stamp'
_OF_ROS = re.compile(r'rclpy|\w+_msgs|\w+_srvs|builtin_interfaces|ament_\w+|rosidl\w*|launch\w*')


def loaded(point: EntryPoint) -> Any:
    """Return what an entry point names; a `MissingDependencyError` for what cannot be loaded."""
    try:
        return point.load()
    except Exception as error:  # a package of others may fail in any way
        package = point.dist.name if point.dist else 'its package'
        raise MissingDependencyError(
            f"'{point.name}' of {package} cannot be loaded ({type(error).__name__}: {error})",
            where=point.group,
            cure=f'install {package} again, or uninstall it',
        ) from error


def refuse_missing(modules: Iterable[str], command: str) -> None:
    """
    Raise a `MissingDependencyError` for the first module that is not installed, or too old.

    ``command`` is the rest of the command line that needs them, for the cure.
    """
    for module in modules:
        if find_spec(module) is None:
            raise MissingDependencyError(
                f"No module named '{module}'", cure=cure_of_missing(module, command)
            )
        extra = EXTRAS.get(module)
        found = '' if extra is None else _version(extra.distribution)
        if extra is not None and found and _numbers(found) < _numbers(extra.least):
            raise MissingDependencyError(
                f'{extra.distribution} {found} is too old: {extra.least} or newer is needed',
                cure=cure_of_missing(module, command),
            )


def _version(name: str) -> str:
    """Version of a distribution; empty where none is recorded."""
    try:
        return distribution(name).version
    except PackageNotFoundError:
        return ''


def _numbers(version: str) -> list[int]:
    """Numbers of a version, without what follows a release."""
    found = re.match(r'\d+(\.\d+)*', version)
    return [int(each) for each in found[0].split('.')] if found else []


def cure_of_missing(module: str, command: str = '...') -> str:
    """Return how to install a missing module, for ``tree-sway`` of a command."""
    package = module.partition('.')[0]
    of_ros = _OF_ROS.fullmatch(package) is not None
    if not of_ros and package not in EXTRAS:
        return f'the installation is incomplete: install {PACKAGE} again'
    if line := line_in_venv(command):
        return f'install it and run this: {line}'
    folder = _folder()
    extra = 'ros' if of_ros else EXTRAS[package].name
    install = f'pip install "{folder or PACKAGE}[{extra}]"'
    if of_ros:
        return f'it needs ROS: source a ROS 2 installation, or {install}'
    return f'install it: {install}'


def line_in_venv(command: str) -> str:
    """
    Return the line that installs what a command of ``tree-sway`` needs, and runs it.

    It is empty outside of the environment that ``.ci/in_venv.py`` makes in a checkout.
    """
    folder = _folder()
    if folder is None or not (Path(sys.prefix) / _STAMP).is_file():
        return ''
    script = Path('.ci', 'in_venv.py')
    # A path that can be typed where the user is.
    shown = script if Path.cwd() == folder else folder / script
    return f'python3 {shown} tree-sway {command}'


def _folder() -> Path | None:
    """Folder that the package was installed from; None if it was not from a folder."""
    try:
        text = distribution(PACKAGE).read_text('direct_url.json')
    except PackageNotFoundError:
        return None
    url = urlparse(json.loads(text).get('url', '') if text else '')
    folder = Path(unquote(url.path))
    return folder if url.scheme == 'file' and (folder / 'setup.py').is_file() else None
