# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The native core of ``native/``, as Python calls it: by ctypes, with checked arrays.

`LIBRARY` is opened once, the build for this processor chosen by itself. `NativeModel` is a model
that the library has checked; `NativeStand` has the states of trees, steps and places them,
a large stand by several threads.
`structures` mirrors the structs of ``library.h`` for observers. What each call does stands in
``sway.h`` and ``library.h``.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.native.library import Address as Address
    from tree_sway.core.native.library import address as address
    from tree_sway.core.native.library import contiguous as contiguous
    from tree_sway.core.native.library import LastAddress as LastAddress
    from tree_sway.core.native.library import LIBRARY as LIBRARY
    from tree_sway.core.native.library import NotCopied as NotCopied
    from tree_sway.core.native.model import AT_POSE as AT_POSE
    from tree_sway.core.native.model import bytes_of as bytes_of
    from tree_sway.core.native.model import NativeModel as NativeModel
    from tree_sway.core.native.stand import NativeStand as NativeStand
    from tree_sway.core.native.stand import States as States
    from tree_sway.core.native.structures import NativeCorrection as NativeCorrection
    from tree_sway.core.native.structures import NativeDragged as NativeDragged
    from tree_sway.core.native.structures import NativeFarWind as NativeFarWind
    from tree_sway.core.native.structures import NativeFilter as NativeFilter
    from tree_sway.core.native.structures import NativeReadings as NativeReadings
    from tree_sway.core.native.structures import NativeSensor as NativeSensor
    from tree_sway.core.native.structures import NativeSeries as NativeSeries
else:
    __getattr__, __dir__, __all__ = face(__name__)
