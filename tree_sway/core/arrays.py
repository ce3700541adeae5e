# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Array types: float64, int64, and the records of the hot path, one and an array of them."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]

#: Arrays of structured records, whose fields `core.motion.records` lists.
Records = NDArray[np.void]


class Record(Protocol):
    """One of them, as kernels read it: its fields are attributes, or items by their names."""

    def __getattr__(self, field: str) -> Any: ...

    def __setattr__(self, field: str, value: object) -> None: ...

    def __getitem__(self, field: str) -> Any: ...

    def __setitem__(self, field: str, value: object) -> None: ...
