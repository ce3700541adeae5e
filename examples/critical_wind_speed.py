# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind at which a stem would break: base strain against mean speed, up to what green wood bears.

    python examples/critical_wind_speed.py [TREE]

The largest strain of a minute is fitted by ``a U^b`` over several speeds; it crosses the strain of
rupture, modulus of rupture over Young's modulus, at the critical speed. This is the stem's own
strength: the anchorage of the roots is not in the model.

"""

import sys

from matplotlib.figure import Figure
import numpy as np

from tree_sway import open_tree, simulate, simulate_turbulence

RATE = 30.0
SPEEDS = (4.0, 6.0, 9.0, 13.0, 18.0)
RUPTURE = 40e6
"""Modulus of rupture of green wood [Pa]: 30 to 65 MPa in the tables of ForestGALES."""


def largest_strain(name: str, speed: float) -> float:
    """Simulate a minute of turbulence, and return the largest strain at the base of the stem."""
    rng = np.random.default_rng(2)
    wind = simulate_turbulence(speed, rate=RATE, duration=60.0, rng=rng)
    record = simulate(open_tree(name), wind, rate=RATE)
    return float(np.linalg.norm(record.base_strain, axis=1).max())


def main(name: str = 'goldcrest') -> Figure:
    """Print the largest strain at each speed, and the critical speed; draw both."""
    limit = RUPTURE / open_tree(name).species.modulus
    largest = []
    for speed in SPEEDS:
        largest.append(largest_strain(name, speed))
        print(f'{speed:5.1f} m/s   largest strain {1e3 * largest[-1]:6.3f} permille')
    power, at_one = np.polyfit(np.log(SPEEDS), np.log(largest), 1)
    critical = np.exp((np.log(limit) - at_one) / power)
    print(f'strain grows with the wind to the power {power:.2f}; {1e3 * limit:.1f} permille: '
          f'green wood breaks at a mean of {critical:.0f} m/s')  # fmt: skip
    axes = (figure := Figure(figsize=(7, 4), layout='constrained')).subplots()
    fitted = np.linspace(SPEEDS[0], 1.05 * critical)
    axes.plot(fitted, 1e3 * np.exp(at_one) * fitted**power, label='fit')
    axes.plot(SPEEDS, 1e3 * np.array(largest), 'o', label='simulated')
    axes.axhline(1e3 * limit, color='grey', linestyle='--', label='rupture')
    axes.set(xlabel='mean wind [m/s]', ylabel='largest strain [permille]', title=name)
    axes.legend()
    return figure


def slider(name: str = 'goldcrest') -> None:
    """Choose the speed by a slider, where ipywidgets is installed."""
    try:
        from ipywidgets import interact
    except ImportError:
        print('a slider needs ipywidgets: pip install ipywidgets')
        return

    @interact(speed=(2.0, 24.0, 1.0), continuous_update=False)
    def show(speed: float = 9.0) -> None:
        print(f'largest strain {1e3 * largest_strain(name, speed):.3f} permille')


if __name__ == '__main__':
    main(*sys.argv[1:])
