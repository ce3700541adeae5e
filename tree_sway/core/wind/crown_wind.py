# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind over a crown: the limbs of a tree do not meet a gust at the same moment.

Two places r apart share a gust of frequency f by the root coherence ``exp(-C f r / U)``, C near 8
(Davenport, 1961, Quarterly Journal of the Royal Meteorological Society 87, 194-211). An anemometer
measures at one place. Of its wind a share c reaches the whole crown at once; the rest reaches each
limb after a delay of its own, spread from 0 to ``3 C r / (2 pi U)``, so that among limbs this rest
fades with f r / U as the source has it. Long gusts reach all limbs alike. Of short ones a limb
feels, in the mean over limbs, ``c^2 + (1 - c)^2`` of the power, as an area does of gusts smaller
than itself.

Delays are dealt to the limbs in the order of the golden ratio: even however many there are, and
the same in every run. Delays follow the mean wind as in `gust_travel`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.checks import within
from tree_sway.core.kernel import entry_of, kernel
from tree_sway.core.wind.gust_travel import follow_mean, LARGEST_STRETCH, remember

DECAY = 8.0
"""Davenport's C in [-], for places across the wind and over each other."""

USUAL_COHERENCE = 0.3
"""
Share of a gust that reaches the whole crown at once, where gusts reach limb after limb.

Gusts of the first frequency of a tree (0.5 to 1 Hz) at 7 m/s have by the source a root coherence
of 0.03 to 0.18 over 3 m; with a share c it is ``c^2 / (c^2 + (1 - c)^2)``, 0.16 with this one.
With it the strain of the stems of grown trees falls above their first frequency as that of real
ones (``tree-sway lab validate --only slopes``).

"""

N_DELAYS = 16
"""Delays that limbs choose from."""

LONGEST_DELAY = 8.0
"""In [s]; of a wide crown in a light wind."""

_SLOWEST = 2.0
_AVERAGING = 30.0
_CAPACITY = 256
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

_LAYOUT = np.dtype(
    [
        ('run', 'f8', (_CAPACITY, 4)),  # time and run of the wind, as `remember` has them
        ('at', 'i8', (2,)),
        ('mean', 'f8', (3,)),
        ('delay', 'f8'),  # the longest [s]
        ('behind', 'f8', (N_DELAYS, 3)),  # run of each delay behind the wind's [m]
        ('apart', 'f8', (N_DELAYS, 3)),  # wind of each delay less the wind [m/s]
        ('spread', 'f8'),
        ('coherence', 'f8'),
    ]
)
_CARRIED = 'run', 'at', 'mean', 'delay', 'behind'


class CrownDelays(NamedTuple):
    """
    Which of `N_DELAYS` each branch has, (b,), what share of the load has each, and their spread.

    That is the longest delay times the wind speed, in [m].
    """

    of_branch: Ints
    share: Floats
    spread: float


def crown_delays(parent: Ints, centre: Floats, load: Floats) -> CrownDelays:
    """
    Deal the delays: the stem has none, and what a limb carries has the limb's.

    Branches have a parent, -1 for the stem, a centre of their wind load [m], (b, 3), and a load of
    any unit, (b,).
    """
    on_stem = parent == 0
    limb = np.where(on_stem, np.cumsum(on_stem), 0)
    for branch, below in enumerate(parent.tolist()):
        if below > 0:
            limb[branch] = limb[below]
    n = int(on_stem.sum()) + 1
    total = np.maximum(np.bincount(limb, load, n), 1e-12)
    middle = np.stack([np.bincount(limb, load * x, n) / total for x in centre.T], axis=1)
    away = np.linalg.norm(middle - np.average(centre, axis=0, weights=load + 1e-12), axis=1)
    away[0] = 0.0
    farthest = max(float(away.max()), 1e-9)
    wanted = (np.arange(n) * _GOLDEN % 1.0) * away / farthest
    of_branch = np.rint(wanted * (N_DELAYS - 1)).astype(np.int64)[limb]
    share = np.bincount(of_branch, load, N_DELAYS)
    spread = 3.0 * DECAY * farthest / (2.0 * math.pi)
    return CrownDelays(of_branch, share / max(float(share.sum()), 1e-12), spread)


def shared_power(coherence: float, spread: float, speed: float, frequencies: Floats) -> Floats:
    """
    Shares of a gust's power that limbs feel alike and each by itself, in the mean over delays.

    Parameters
    ----------
    coherence, spread
        As of `CrownWind`.
    speed
        Mean wind speed in [m/s].
    frequencies
        In [Hz], (f,).

    Returns
    -------
    Floats
        In [-], (2, f): 1 and 0 for the slowest gusts.

    """
    longest = min(spread / max(speed, _SLOWEST), LONGEST_DELAY)
    turned = np.sinc(frequencies * longest) * np.exp(-1j * np.pi * frequencies * longest)
    rest = 1.0 - coherence
    alike = np.abs(coherence + rest * turned) ** 2
    return np.stack([alike, rest**2 * (1.0 - np.abs(turned) ** 2)])


class CrownWind:
    """
    The wind of the last seconds, and what of it each limb feels now.

    The spread is that of `CrownDelays`; the coherence, 0 to 1, else a `ParameterError`, is the
    share of the wind that reaches all at once.
    """

    def __init__(self, spread: float, coherence: float) -> None:
        """Start without wind."""
        self.record = np.zeros(1, dtype=_LAYOUT)
        self.record['spread'] = spread
        self.record['coherence'] = within('crown_coherence', coherence, 0.0, 1.0)

    def push(self, x: float, y: float, z: float, dt: float) -> Floats:
        """
        Take the mean wind [m/s] of a step of dt [s]; return what each delay adds, (`N_DELAYS`, 3).

        It is the same array each time.
        """
        self._compiled(x, y, z, dt)
        return np.asarray(self.record['apart'][0])

    @cached_property
    def _compiled(self) -> Callable[[float, float, float, float], None]:
        return partial(entry_of(push_wind, self.record, 0.0, 0.0, 0.0, 0.0), self.record)

    def memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of what is carried from one step to the next."""
        return tuple(self.record[name] for name in _CARRIED)

    def follow(self, other: CrownWind) -> None:
        """Go on with the wind that another has felt."""
        for own, theirs in zip(self.memory(), other.memory(), strict=True):
            own[...] = theirs

    def reset(self) -> None:
        """Forget the wind."""
        for array in self.memory():
            array[...] = 0
        self.record['apart'] = 0.0


@kernel
def push_wind(crowns: Records, x: float, y: float, z: float, dt: float) -> None:
    """Do what `CrownWind.push` does, for the first record of an array."""
    here = crowns[0]
    run, at, mean = here['run'], here['at'], here['mean']
    behind, apart = here['behind'], here['apart']
    is_first = at[1] == 0
    remember(run, at, 2.0 * LONGEST_DELAY / (len(run) - 4), x, y, z, dt)
    follow_mean(mean, x, y, dt, _AVERAGING)
    speed = max(math.hypot(mean[0], mean[1]), _SLOWEST)
    goal, most = min(here['spread'] / speed, LONGEST_DELAY), LARGEST_STRETCH * dt
    before = goal if is_first else here['delay']
    delay = min(max(goal, before - most), before + most)
    here['delay'] = delay
    head, cell, rest = run[at[0]], at[0] - 1, 1.0 - here['coherence']
    for j in range(1, len(apart)):
        share = j / (len(apart) - 1)
        if is_first:
            lag = share * before
            behind[j, 0], behind[j, 1], behind[j, 2] = lag * x, lag * y, lag * z
        late = share * delay
        cell = _cell_before(run, at, cell, head[0] - late)
        bx, by, bz = _run_in(run, cell, head[0] - late)
        per_span = rest / (dt + share * (before - delay))
        bx, by, bz = head[1] - bx, head[2] - by, head[3] - bz
        apart[j, 0] = per_span * (x * dt + behind[j, 0] - bx) - rest * x
        apart[j, 1] = per_span * (y * dt + behind[j, 1] - by) - rest * y
        apart[j, 2] = per_span * (z * dt + behind[j, 2] - bz) - rest * z
        behind[j, 0], behind[j, 1], behind[j, 2] = bx, by, bz


@kernel
def _cell_before(run: Floats, at: Ints, cell: int, time: float) -> int:
    """Find the last row of the history that is not after a time, from a later one on backwards."""
    size, oldest = len(run), at[0] - at[1] + 1
    while cell > oldest and run[cell + size if cell < 0 else cell, 0] > time:
        cell -= 1
    return cell


@kernel
def _run_in(run: Floats, cell: int, time: float) -> tuple[float, float, float]:
    """Run of the wind at a time, by a straight line through a row of the history and the next."""
    size, after = len(run), cell + 1
    a, b = run[cell + size if cell < 0 else cell], run[after + size if after < 0 else after]
    u = (time - a[0]) / (b[0] - a[0])
    return a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2]), a[3] + u * (b[3] - a[3])
