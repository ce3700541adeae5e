# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Spectra of the wind and of the tip that it moves: where a tree amplifies a wind, and where not.

    python examples/response_spectra.py [TREE] [PICTURE]

The ratio of the two, the mechanical transfer function that field studies measure (Mayer 1987), has
its peak at the slowest sway; the wind's own spectrum falls steeply there.

"""

import sys

from matplotlib.figure import Figure
import numpy as np
from scipy.signal import welch

from tree_sway import open_tree, simulate, simulate_turbulence

RATE, SECONDS, SPEED = 20.0, 600.0, 8.0


def main(name: str = 'goldcrest', picture: str = '') -> Figure:
    """Simulate ten minutes, print the peak, and draw; save the picture if it is named."""
    rng = np.random.default_rng(1)
    wind = simulate_turbulence(SPEED, rate=RATE, duration=SECONDS, rng=rng)
    record = simulate(open_tree(name), wind, rate=RATE)
    samples = round(60.0 * RATE)  # of a minute: bands of 1/60 Hz
    frequency, gust = welch(record.wind[:, 0], RATE, nperseg=samples)
    _, tip = welch(record.tips[:, 0, 0], RATE, nperseg=samples)
    ratio = tip[1:] / gust[1:]
    peak = frequency[1:][np.argmax(ratio)]
    print(f'{record.tree}: sways most at {peak:.2f} Hz, {ratio.max() / ratio[0]:.0f} times '
          'the displacement per wind of slow gusts (as power)')  # fmt: skip
    axes = (figure := Figure(figsize=(7, 4), layout='constrained')).subplots()
    axes.loglog(frequency[1:], gust[1:], label='wind [(m/s)$^2$/Hz]')
    axes.loglog(frequency[1:], tip[1:], label='tip [m$^2$/Hz]')
    axes.axvline(peak, color='grey', linewidth=0.8)
    axes.set(xlabel='frequency [Hz]', title=f'{record.tree}, {SPEED:g} m/s')
    axes.legend()
    if picture:
        figure.savefig(picture)
    return figure


if __name__ == '__main__':
    main(*sys.argv[1:])
