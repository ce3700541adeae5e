"""Tables in text: which character separates, what the header says, where a row goes wrong."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.text_file import finite, why_no_number

_MAX_COLUMNS = 10_000


@dataclass(frozen=True)
class TextTable:
    """
    A table with a header.

    Parameters
    ----------
    columns
        Names in the header, stripped.
    rows
        Line number and cells of each row that is not blank.
    source
        The file, for the errors.

    """

    columns: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    source: str

    def column_index(self, *names: str) -> int:
        """
        Position of the first of these columns that is there.

        Raises
        ------
        FormatError
            If none is.

        """
        lower = [column.lower() for column in self.columns]
        for name in names:
            if name.lower() in lower:
                return lower.index(name.lower())
        raise FormatError(
            f"no column '{names[0]}' among {', '.join(self.columns[:20])}",
            where=f"{self.source}:1",
            cure="export it with its header line, unchanged",
        )

    def numbers(self, names: Sequence[str]) -> Iterator[tuple[int, list[float]]]:
        """
        Line number and the values of these columns, row by row.

        Raises
        ------
        FormatError
            At the first row that is short or holds something that is not a finite number.

        """
        indices = [self.column_index(name) for name in names]
        for line, cells in self.rows:
            yield line, row_numbers(cells, indices, names, f"{self.source}:{line}")


def row_numbers(
    cells: Sequence[str], indices: Iterable[int], names: Sequence[str], where: str
) -> list[float]:
    """Values of some cells of a row; a FormatError if one is not a finite number."""
    values = []
    for index, name in zip(indices, names, strict=True):
        if index >= len(cells):
            raise FormatError(
                f"{len(cells)} cells, none for '{name}'", where=where, cure="complete the row"
            )
        value = finite(cells[index])
        if value is None:
            raise FormatError(
                f"{name} is {why_no_number(cells[index])}",
                where=where,
                cure="mend the cell or remove the row",
            )
        values.append(value)
    return values


def whole(value: float, name: str, where: str) -> int:
    """Return a whole number; a FormatError if it has a fraction or is out of any table's reach."""
    if not value.is_integer() or abs(value) > 2**53:
        raise FormatError(f"{name} is {value:g}, not a whole number", where=where)
    return int(value)


def split_row(line: str, separator: str) -> tuple[str, ...]:
    """Cells of one line, stripped; quoted cells may hold the separator but no line end."""
    if '"' not in line:
        return tuple(cell.strip() for cell in line.split(separator))
    try:
        return tuple(cell.strip() for cell in next(csv.reader([line], delimiter=separator)))
    except csv.Error:
        return ()


def separator_of(header: str) -> str:
    """Return the separator that a header uses: the most frequent of tab, semicolon and comma."""
    return max(("\t", ";", ","), key=header.count)


def parse_table(lines: Sequence[str], source: str, comment: str = "#") -> TextTable:
    """
    Parse a table whose first line that is neither blank nor a comment is the header.

    Raises
    ------
    FormatError
        If there is no header or no row.

    """
    numbered = [
        (number, line)
        for number, line in enumerate(lines, start=1)
        if line.strip() and not line.lstrip().startswith(comment)
    ]
    if len(numbered) < 2:
        raise FormatError("no header and rows", where=source, cure="give a header and rows")
    separator = separator_of(numbered[0][1])
    columns = split_row(numbered[0][1], separator)
    if len(columns) > _MAX_COLUMNS:
        raise FormatError(f"a header of {len(columns)} columns", where=f"{source}:{numbered[0][0]}")
    rows = tuple((number, split_row(line, separator)) for number, line in numbered[1:])
    _refuse_shifted(columns, rows, source)
    return TextTable(columns, rows, source)


def _refuse_shifted(
    columns: tuple[str, ...], rows: tuple[tuple[int, tuple[str, ...]], ...], source: str
) -> None:
    """Refuse a table most rows of which have more cells than the header."""
    long = [number for number, cells in rows if any(cells[len(columns) :])]
    if 2 * len(long) > len(rows):
        raise FormatError(
            f"more cells than the {len(columns)} columns of the header, as in most rows",
            where=f"{source}:{long[0]}",
            cure="if its numbers have decimal commas, export it with decimal points; "
            "else name every column in the header",
        )
