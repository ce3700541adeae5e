# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Writing of many poses to memory without reading it first, for stands larger than the caches."""

from __future__ import annotations

from typing import Any

from tree_sway.core.kernel import WHY_PLAIN


def write_past_caches(of: Any, into: Any) -> None:
    """
    Copy an array (n,) to memory that is not read soon, without reading it first.

    Ordinary writes to memory beyond the caches read it first. `settle` makes the data visible to
    other threads.
    """
    into[:] = of


def settle() -> None:
    """Wait until all written data is visible to other threads."""


if not WHY_PLAIN:
    from numba.core import cgutils, types
    from numba.extending import intrinsic, overload

    from tree_sway.core.run.simd import element_at, generated

    llvm = cgutils.ir
    _LINE = llvm.VectorType(llvm.DoubleType(), 8)

    @intrinsic
    def _write_line(typing, into, at, of, row):  # type: ignore[no-untyped-def]
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            kinds = signature.args
            line = _LINE.as_pointer()
            target = builder.bitcast(element_at(context, builder, kinds[0], *values[:2]), line)
            source = builder.bitcast(element_at(context, builder, kinds[2], *values[2:]), line)
            written = builder.store(builder.load(source, align=8), target, align=64)
            note = builder.module.add_metadata([llvm.IntType(32)(1)])
            written.set_metadata('nontemporal', note)
            return context.get_dummy_value()

        return types.none(into, types.intp, of, types.intp), generate

    @generated(settle, lambda: types.none())
    def _fence(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        builder.fence('seq_cst')
        return context.get_dummy_value()

    @overload(write_past_caches)
    def _write_past_caches(of, into):  # type: ignore[no-untyped-def]
        def write(of, into):  # type: ignore[no-untyped-def]
            count = len(of)
            address = into.ctypes.data
            # Lines of a cache begin at multiples of 64 bytes.
            first = count
            if address % 8 == 0:
                first = min((64 - address % 64) % 64 // 8, count)
            for number in range(first):
                into[number] = of[number]
            last = first + (count - first) // 8 * 8
            for number in range(first, last, 8):
                _write_line(into, number, of, number)
            for number in range(last, count):
                into[number] = of[number]

        return write
