# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Four numbers of each of four rows to four lanes and back, as vectors.

A branch's pose lies in one row, sixteen branches are computed in lanes: number by number, carrying
them over takes longer than computing them.
"""

from __future__ import annotations

from typing import Any

from tree_sway_ros.core.kernel import WHY_PLAIN


def put_four(lanes: Any, row: int, lane: int, a: Any, b: Any, c: Any, d: Any, first: int) -> None:
    """
    Write four rows of four lanes, from a row and lane on, to a, b, c and d from an element on.

    All lie in one piece.
    """
    for to, j in ((a, lane), (b, lane + 1), (c, lane + 2), (d, lane + 3)):
        to[first : first + 4] = lanes[row : row + 4, j]


def take_four(a: Any, b: Any, c: Any, d: Any, first: int, lanes: Any, row: int, lane: int) -> None:
    """Read what `put_four` writes."""
    for of, j in ((a, lane), (b, lane + 1), (c, lane + 2), (d, lane + 3)):
        lanes[row : row + 4, j] = of[first : first + 4]


def write_past_caches(of: Any, into: Any) -> None:
    """
    Copy an array (n,) to memory that is not read soon, without reading it first.

    What is written to memory beyond the caches is else fetched from there before. `settle` makes
    it seen by other threads.
    """
    into[:] = of


def settle() -> None:
    """Wait until all that was written is seen by other threads."""


if not WHY_PLAIN:
    from numba.core import cgutils, types
    from numba.extending import intrinsic, overload

    ir = cgutils.ir
    _VECTOR = ir.VectorType(ir.DoubleType(), 4)

    def _element(context: Any, builder: Any, kind: Any, array: Any, *index: Any) -> Any:
        array = context.make_array(kind)(context, builder, array)
        return cgutils.get_item_pointer(context, builder, kind, array, index)

    def _place(context: Any, builder: Any, kind: Any, array: Any, *index: Any) -> Any:
        """Where four numbers begin."""
        element = _element(context, builder, kind, array, *index)
        return builder.bitcast(element, _VECTOR.as_pointer())

    def _turned(builder: Any, rows: list[Any]) -> tuple[Any, ...]:
        """Four vectors of the first, second, third and fourth numbers of four."""

        def mixed(one: Any, other: Any, which: list[int]) -> Any:
            picked = ir.Constant(ir.VectorType(ir.IntType(32), 4), which)
            return builder.shuffle_vector(one, other, picked)

        a, b, c, d = rows
        low, high = [0, 4, 2, 6], [1, 5, 3, 7]
        ab, cd, ba, dc = mixed(a, b, low), mixed(c, d, low), mixed(a, b, high), mixed(c, d, high)
        low, high = [0, 1, 4, 5], [2, 3, 6, 7]
        return mixed(ab, cd, low), mixed(ba, dc, low), mixed(ab, cd, high), mixed(ba, dc, high)

    def _carried(is_put: bool) -> Any:
        def carry(typing, lanes, row, lane, a, b, c, d, first):  # type: ignore[no-untyped-def]
            def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
                kinds = signature.args
                lanes, row, lane, *rows, first = values
                of = [
                    _place(
                        context, builder, kinds[0], lanes,
                        builder.add(row, row.type(k)), lane,
                    )
                    for k in range(4)
                ]  # fmt: skip
                to = [
                    _place(context, builder, kind, each, first)
                    for kind, each in zip(kinds[3:7], rows, strict=True)
                ]
                of, to = (of, to) if is_put else (to, of)
                read = [builder.load(where, align=8) for where in of]
                for value, where in zip(_turned(builder, read), to, strict=True):
                    builder.store(value, where, align=8)
                return context.get_dummy_value()

            return types.none(lanes, types.intp, types.intp, a, b, c, d, types.intp), generate

        return intrinsic(carry)

    _put, _take = _carried(True), _carried(False)

    @overload(put_four, inline='always')
    def _put_four(lanes, row, lane, a, b, c, d, first):  # type: ignore[no-untyped-def]
        return lambda lanes, row, lane, a, b, c, d, first: _put(
            lanes, row, lane, a, b, c, d, first
        )

    @overload(take_four, inline='always')
    def _take_four(a, b, c, d, first, lanes, row, lane):  # type: ignore[no-untyped-def]
        return lambda a, b, c, d, first, lanes, row, lane: _take(
            lanes, row, lane, a, b, c, d, first
        )

    _LINE = ir.VectorType(ir.DoubleType(), 8)

    @intrinsic
    def _write_line(typing, into, at, of, row):  # type: ignore[no-untyped-def]
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            kinds, line = signature.args, _LINE.as_pointer()
            to = builder.bitcast(_element(context, builder, kinds[0], *values[:2]), line)
            read = builder.bitcast(_element(context, builder, kinds[2], *values[2:]), line)
            written = builder.store(builder.load(read, align=8), to, align=64)
            told = builder.module.add_metadata([ir.IntType(32)(1)])
            written.set_metadata('nontemporal', told)
            return context.get_dummy_value()

        return types.none(into, types.intp, of, types.intp), generate

    @intrinsic
    def _fence(typing):  # type: ignore[no-untyped-def]
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            builder.fence('seq_cst')
            return context.get_dummy_value()

        return types.none(), generate

    @overload(settle, inline='always')
    def _settle():  # type: ignore[no-untyped-def]
        return lambda: _fence()

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
