"""
``tree-sway docs``: the tables of topics, parameters and species, taken from the code and put into
the pages.

A table stands between two comments, ``<!-- table: NAME -->`` and ``<!-- end -->``; what is between
them is replaced.

"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from tree_sway_ros.core.tree.species import species_keys, species_named
from tree_sway_ros.errors import FormatError
from tree_sway_ros.ros.parameters import parameter as parameters
from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.ros.process import topics

PAGES = ("README.md", "doc/trees.md")
"""Pages with tables."""

_TABLE = re.compile(r"(<!-- table: (?P<name>\S+) -->\n).*?(<!-- end -->)", re.DOTALL)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "files", nargs="*", default=PAGES, help=f"files with tables ({', '.join(PAGES)})"
    )
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 2 if not up to date"
    )


def run(arguments: argparse.Namespace) -> int:
    """Bring the tables of the files up to date, or check that they are."""
    for file in arguments.files:
        path = Path(file)
        text = path.read_text(encoding="utf-8")
        fresh = with_tables(text, where=str(path))
        if fresh == text:
            print(f"{path}: up to date")
            continue
        if arguments.check:
            raise FormatError("not up to date", where=str(path), cure="run tree-sway docs")
        path.write_text(fresh, encoding="utf-8")
        print(f"{path}: tables written")
    return 0


def with_tables(text: str, where: str = "text") -> str:
    """
    Replace the tables in a text by those of the code.

    Parameters
    ----------
    text
        Markdown with tables between marks.
    where
        Its name, for the error.

    Returns
    -------
    str
        The same text with fresh tables.

    Raises
    ------
    FormatError
        If a mark names a table that does not exist.

    """
    tables = markdown_tables()

    def fill(match: re.Match[str]) -> str:
        name = match["name"]
        if name not in tables:
            cure = f"name one of: {', '.join(tables)}"
            raise FormatError(f"no table is called '{name}'", where=where, cure=cure)
        return f"{match[1]}{tables[name]}{match[3]}"

    return _TABLE.sub(fill, text)


def markdown_tables() -> dict[str, str]:
    """
    Every table by its name: ``topics``, ``species``, and the parameters of each node by the node's
    name.

    """
    tables = {"topics": topics.markdown_table(), "species": species_table()}
    for node, table in NODE_PARAMETERS.items():
        tables[node] = parameters.markdown_table(table)
    return tables


def species_table() -> str:
    """Wood, damping, drag and leaves of every species."""
    lines = [
        "| key | species | E [GPa] | density [kg/m^3] | damping bare, in leaf | drag in leaf | "
        "leaves [m^2/m^2] | [kg/m^2] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for key in species_keys():
        wood, leaf = species_named(key), species_named(key).leaves
        mark = " (an estimate)" if wood.is_estimate else ""
        lines.append(
            f"| `{key}` | {wood.title}{mark} | {wood.modulus / 1e9:.3g} | {wood.density:g} "
            f"| {wood.damping_bare:g}, {wood.damping_in_leaf:g} "
            f"| {wood.drag_coefficient:g} U^-{wood.drag_exponent:g} "
            f"| {leaf.area_per_section:g}{', evergreen' if leaf.is_evergreen else ''} | "
            f"{leaf.fresh_mass:g} |"
        )
    return "\n".join(lines) + "\n"
