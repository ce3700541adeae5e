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
    for to, j in ((a, slot), (b, slot + 1), (c, slot + 2), (d, slot + 3)):
        array[to, first : first + 4] = slots[row : row + 4, j]


def take_four(
    array: Any, a: int, b: int, c: int, d: int, first: int, slots: Any, row: int, slot: int
) -> None:
    """Read rows as `put_four` writes them, or four numbers each of an array (n,)."""
    for of, j in ((a, slot), (b, slot + 1), (c, slot + 2), (d, slot + 3)):
        rows = array[of] if array.ndim == 2 else array[of:]
        slots[row : row + 4, j] = rows[first : first + 4]


def write_past_caches(of: Any, into: Any) -> None:
    """
    Copy an array (n,) to memory that is not read soon, without reading it first.

    Ordinary writes to memory beyond the caches read it first. `settle` makes the data visible to
    other threads.
    """
    into[:] = of


def settle() -> None:
    """Wait until all written data is visible to other threads."""


def shapes_together(shapes: Floats) -> Any:
    """Lay shapes (k, n) out for `add_shapes`: (ceil(n / 64), k, 64), in single precision."""
    k, n = shapes.shape
    blocks = -(-n // TOGETHER)
    laid: Any = zeros_in_lines(blocks, np.dtype([('shapes', 'f4', (k, TOGETHER))]))['shapes']
    whole = np.zeros((k, blocks * TOGETHER))
    whole[:, :n] = shapes
    laid[:] = whole.reshape(k, blocks, TOGETHER).swapaxes(0, 1)
    return laid


def add_shapes(shapes: Any, block: int, amounts: Any, into: Any) -> None:
    """Write a block's coordinates: the sum of shapes of `shapes_together` times amounts (k,)."""
    into[block * TOGETHER : (block + 1) * TOGETHER] = amounts @ shapes[block].astype(np.float64)


if not WHY_PLAIN:
    from numba.core import cgutils, types
    from numba.extending import intrinsic, lower_builtin, overload, type_callable

    ir = cgutils.ir
    _VECTOR = ir.VectorType(ir.DoubleType(), 4)

    def _element(context: Any, builder: Any, kind: Any, array: Any, *index: Any) -> Any:
        array = context.make_array(kind)(context, builder, array)
        return cgutils.get_item_pointer(context, builder, kind, array, index)

    def _place(context: Any, builder: Any, kind: Any, array: Any, *index: Any) -> Any:
        """Return the address of four numbers."""
        element = _element(context, builder, kind, array, *index)
        return builder.bitcast(element, _VECTOR.as_pointer())

    def _turned(builder: Any, rows: list[Any]) -> tuple[Any, ...]:
        """Transpose four vectors of four numbers."""

        def mixed(one: Any, other: Any, which: list[int]) -> Any:
            picked = ir.Constant(ir.VectorType(ir.IntType(32), 4), which)
            return builder.shuffle_vector(one, other, picked)

        a, b, c, d = rows
        low, high = [0, 4, 2, 6], [1, 5, 3, 7]
        ab, cd, ba, dc = mixed(a, b, low), mixed(c, d, low), mixed(a, b, high), mixed(c, d, high)
        low, high = [0, 1, 4, 5], [2, 3, 6, 7]
        return mixed(ab, cd, low), mixed(ba, dc, low), mixed(ab, cd, high), mixed(ba, dc, high)

    def _generated(function: Any, typed: Any) -> Any:
        """Generate code for a function, which compiles faster than a call of an intrinsic."""
        type_callable(function)(lambda context: typed)
        return lower_builtin(function, types.VarArg(types.Any))  # type: ignore[attr-defined]

    def _carried(is_put: bool) -> Any:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            turn = 0 if is_put else 6
            kinds, given = (each[turn:] + each[:turn] for each in (signature.args, tuple(values)))
            slots, row, slot, array, *at, first = given
            rows = [builder.add(row, row.type(k)) for k in range(4)]
            source = [_place(context, builder, kinds[0], slots, each, slot) for each in rows]
            if kinds[3].ndim == 2:
                to = [_place(context, builder, kinds[3], array, each, first) for each in at]
            else:
                at = [builder.add(each, first) for each in at]
                to = [_place(context, builder, kinds[3], array, each) for each in at]
            source, to = (source, to) if is_put else (to, source)
            read = [builder.load(where, align=8) for where in source]
            for value, where in zip(_turned(builder, read), to, strict=True):
                builder.store(value, where, align=8)
            return context.get_dummy_value()

        return generate

    _AT, _ROWS = 2 * (types.intp,), 5 * (types.intp,)
    _generated(
        put_four,
        lambda slots, row, slot, rows, a, b, c, d, first: types.none(slots, *_AT, rows, *_ROWS),
    )(_carried(is_put=True))
    _generated(
        take_four,
        lambda rows, a, b, c, d, first, slots, row, slot: types.none(rows, *_ROWS, slots, *_AT),
    )(_carried(is_put=False))

    _LINE = ir.VectorType(ir.DoubleType(), 8)

    @intrinsic
    def _write_line(typing, into, at, of, row):  # type: ignore[no-untyped-def]
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            kinds, line = signature.args, _LINE.as_pointer()
            to = builder.bitcast(_element(context, builder, kinds[0], *values[:2]), line)
            read = builder.bitcast(_element(context, builder, kinds[2], *values[2:]), line)
            written = builder.store(builder.load(read, align=8), to, align=64)
            note = builder.module.add_metadata([ir.IntType(32)(1)])
            written.set_metadata('nontemporal', note)
            return context.get_dummy_value()

        return types.none(into, types.intp, of, types.intp), generate

    _SINGLES, _DOUBLES = (ir.VectorType(kind(), 16) for kind in (ir.FloatType, ir.DoubleType))

    @_generated(add_shapes, lambda table, block, by, to: types.none(table, types.intp, by, to))
    def _add(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        kinds, (table, row, shares, to) = signature.args, values
        none = ir.Constant(_SINGLES, None)
        sums = [cgutils.alloca_once_value(builder, none) for _ in range(TOGETHER // 16)]
        count = context.make_array(kinds[2])(context, builder, shares).nitems
        with cgutils.for_range(builder, count) as loop:
            share = builder.load(_element(context, builder, kinds[2], shares, loop.index))
            one = builder.insert_element(none, share, ir.IntType(32)(0))
            every = ir.Constant(ir.VectorType(ir.IntType(32), 16), None)
            shared = builder.shuffle_vector(one, none, every)
            at = _element(context, builder, kinds[0], table, row, loop.index, row.type(0))
            at = builder.bitcast(at, _SINGLES.as_pointer())
            for k, total in enumerate(sums):
                read = builder.load(builder.gep(at, [row.type(k)]), align=64)
                part = builder.fmul(read, shared, flags=['contract'])
                whole = builder.fadd(builder.load(total), part, flags=['contract'])
                builder.store(whole, total)
        at = builder.mul(row, row.type(TOGETHER))
        for k, total in enumerate(sums):
            first = builder.add(at, row.type(16 * k))
            where = _element(context, builder, kinds[3], to, first)
            written = builder.bitcast(where, _DOUBLES.as_pointer())
            builder.store(builder.fpext(builder.load(total), _DOUBLES), written, align=8)
        return context.get_dummy_value()

    @_generated(settle, lambda: types.none())
    def _fence(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        builder.fence('seq_cst')
        return context.get_dummy_value()

    @overload(write_past_caches)
    def _write_past_caches(of, into):  # type: ignore[no-untyped-def]
        def write(of, into):  # type: ignore[no-untyped-def]
            n, address = len(of), into.ctypes.data
            first = min((64 - address % 64) % 64 // 8, n) if address % 8 == 0 else n
            for i in range(first):
                into[i] = of[i]
            last = first + (n - first) // 8 * 8
            for i in range(first, last, 8):
                _write_line(into, i, of, i)
            for i in range(last, n):
                into[i] = of[i]

        return write
