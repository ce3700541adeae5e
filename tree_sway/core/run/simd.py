# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Operations that compilers do not vectorise.

The pose of a branch is a row, and sixteen branches are computed in slots: to transpose them number
by number takes longer than to compute them. The shapes of a tree of many branches are its largest
table: each is read once, stored and summed in single precision.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.model.records import zeros_in_lines

TOGETHER = 64
"""Coordinates whose shapes are contiguous and summed at once."""


def put_four(
    slots: Any, row: int, slot: int, array: Any, a: int, b: int, c: int, d: int, first: int
) -> None:
    """
    Write four rows of four slots, from a row and slot on, to rows a, b, c and d of an array.

    The numbers of a row are written from an element ``first`` on.
    """
    for offset, target in enumerate((a, b, c, d)):
        array[target, first : first + 4] = slots[row : row + 4, slot + offset]


def take_four(
    array: Any, a: int, b: int, c: int, d: int, first: int, slots: Any, row: int, slot: int
) -> None:
    """Read rows as `put_four` writes them, or four numbers each of an array (n,)."""
    for offset, source in enumerate((a, b, c, d)):
        numbers = array[source] if array.ndim == 2 else array[source:]
        slots[row : row + 4, slot + offset] = numbers[first : first + 4]


def shapes_together(shapes: Floats) -> Any:
    """Lay shapes (k, n) out for `add_shapes`: (ceil(n / 64), k, 64), in single precision."""
    n_shapes, n_coordinates = shapes.shape
    n_blocks = -(-n_coordinates // TOGETHER)
    layout = np.dtype([('shapes', 'f4', (n_shapes, TOGETHER))])
    laid: Any = zeros_in_lines(n_blocks, layout)['shapes']
    padded = np.zeros((n_shapes, n_blocks * TOGETHER))
    padded[:, :n_coordinates] = shapes
    laid[:] = padded.reshape(n_shapes, n_blocks, TOGETHER).swapaxes(0, 1)
    return laid


def add_shapes(shapes: Any, block: int, amounts: Any, into: Any) -> None:
    """Write a block's coordinates: the sum of shapes of `shapes_together` times amounts (k,)."""
    into[block * TOGETHER : (block + 1) * TOGETHER] = amounts @ shapes[block].astype(np.float64)


if not WHY_PLAIN:
    from numba.core import cgutils, types
    from numba.extending import lower_builtin, type_callable

    llvm = cgutils.ir
    _VECTOR = llvm.VectorType(llvm.DoubleType(), 4)
    _INTEGER = llvm.IntType(32)

    def element_at(context: Any, builder: Any, kind: Any, array: Any, *index: Any) -> Any:
        """Return the address of an element of an array."""
        array = context.make_array(kind)(context, builder, array)
        return cgutils.get_item_pointer(context, builder, kind, array, index)

    def _place(context: Any, builder: Any, kind: Any, array: Any, *index: Any) -> Any:
        """Return the address of four numbers."""
        element = element_at(context, builder, kind, array, *index)
        return builder.bitcast(element, _VECTOR.as_pointer())

    def _turned(builder: Any, rows: list[Any]) -> tuple[Any, ...]:
        """Transpose four vectors of four numbers."""

        def mixed(one: Any, other: Any, which: list[int]) -> Any:
            picked = llvm.Constant(llvm.VectorType(_INTEGER, 4), which)
            return builder.shuffle_vector(one, other, picked)

        # First the squares of two numbers in the corners are transposed, then their places.
        even = [0, 4, 2, 6]
        odd = [1, 5, 3, 7]
        upper_even = mixed(rows[0], rows[1], even)
        lower_even = mixed(rows[2], rows[3], even)
        upper_odd = mixed(rows[0], rows[1], odd)
        lower_odd = mixed(rows[2], rows[3], odd)
        front = [0, 1, 4, 5]
        back = [2, 3, 6, 7]
        return (
            mixed(upper_even, lower_even, front),
            mixed(upper_odd, lower_odd, front),
            mixed(upper_even, lower_even, back),
            mixed(upper_odd, lower_odd, back),
        )

    def generated(function: Any, typed: Any) -> Any:
        """Generate code for a function, which compiles faster than a call of an intrinsic."""
        type_callable(function)(lambda context: typed)
        return lower_builtin(function, types.VarArg(types.Any))  # type: ignore[attr-defined]

    def _carried(is_put: bool) -> Any:
        """Return what generates `put_four`, or `take_four`, whose slots come after the array."""

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            n_before_slots = 0 if is_put else 6
            kinds, given = (
                each[n_before_slots:] + each[:n_before_slots]
                for each in (signature.args, tuple(values))
            )
            slots, row, slot, array, *array_rows, first = given
            slot_rows = [builder.add(row, row.type(offset)) for offset in range(4)]
            in_slots = [
                _place(context, builder, kinds[0], slots, each, slot) for each in slot_rows
            ]
            index: list[tuple[Any, ...]] = [(each, first) for each in array_rows]
            if kinds[3].ndim == 1:
                index = [(builder.add(each, first),) for each in array_rows]
            in_array = [_place(context, builder, kinds[3], array, *each) for each in index]
            sources, targets = (in_slots, in_array) if is_put else (in_array, in_slots)
            read = [builder.load(where, align=8) for where in sources]
            for value, where in zip(_turned(builder, read), targets, strict=True):
                builder.store(value, where, align=8)
            return context.get_dummy_value()

        return generate

    _AT = 2 * (types.intp,)
    _ROWS = 5 * (types.intp,)
    generated(
        put_four,
        lambda slots, row, slot, rows, a, b, c, d, first: types.none(slots, *_AT, rows, *_ROWS),
    )(_carried(is_put=True))
    generated(
        take_four,
        lambda rows, a, b, c, d, first, slots, row, slot: types.none(rows, *_ROWS, slots, *_AT),
    )(_carried(is_put=False))

    _SINGLES = llvm.VectorType(llvm.FloatType(), 16)
    _DOUBLES = llvm.VectorType(llvm.DoubleType(), 16)

    @generated(add_shapes, lambda table, block, by, to: types.none(table, types.intp, by, to))
    def _add(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        kinds = signature.args
        table, block, amounts, target = values
        zeros = llvm.Constant(_SINGLES, None)
        sums = [cgutils.alloca_once_value(builder, zeros) for _ in range(TOGETHER // 16)]
        n_shapes = context.make_array(kinds[2])(context, builder, amounts).nitems
        with cgutils.for_range(builder, n_shapes) as loop:
            amount = builder.load(element_at(context, builder, kinds[2], amounts, loop.index))
            in_first = builder.insert_element(zeros, amount, _INTEGER(0))
            first_for_all = llvm.Constant(llvm.VectorType(_INTEGER, 16), None)
            in_all = builder.shuffle_vector(in_first, zeros, first_for_all)
            shape = element_at(context, builder, kinds[0], table, block, loop.index, block.type(0))
            shape = builder.bitcast(shape, _SINGLES.as_pointer())
            for sixteen, total in enumerate(sums):
                read = builder.load(builder.gep(shape, [block.type(sixteen)]), align=64)
                added = builder.fmul(read, in_all, flags=['contract'])
                whole = builder.fadd(builder.load(total), added, flags=['contract'])
                builder.store(whole, total)
        begin = builder.mul(block, block.type(TOGETHER))
        for sixteen, total in enumerate(sums):
            first = builder.add(begin, block.type(16 * sixteen))
            where = element_at(context, builder, kinds[3], target, first)
            written = builder.bitcast(where, _DOUBLES.as_pointer())
            builder.store(builder.fpext(builder.load(total), _DOUBLES), written, align=8)
        return context.get_dummy_value()
