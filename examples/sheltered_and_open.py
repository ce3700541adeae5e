# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The same tree in the open and among others of its height, under the same wind at the tops.

    python examples/sheltered_and_open.py

Over open ground the wind falls with height by a logarithm; within a canopy it falls exponentially
from the tops down (Cionco 1965), here as the power law that fits that best. The crown of the
sheltered tree gets less wind, and its base carries less, though its top is as exposed.

"""

from matplotlib.figure import Figure
import numpy as np

from tree_sway import grow, simulate, simulate_turbulence
from tree_sway.core.wind import WindProfile

HEIGHT, SPEED, RATE = 12.0, 9.0, 30.0
ATTENUATION = 2.0
"""Of the exponential profile: 1 in a sparse canopy to 4 in a dense one."""


def profiles() -> dict[str, WindProfile]:
    """Return the two profiles, equal at the height of the tops."""
    z = np.linspace(0.3, 1.0, 50)
    exponent = float(np.log(z) @ (ATTENUATION * (z - 1.0)) / (np.log(z) @ np.log(z)))
    return {
        'open': WindProfile('log', HEIGHT, roughness=0.03),
        'sheltered': WindProfile('power', HEIGHT, exponent=exponent),
    }


def main() -> Figure:
    """Print mean and largest tip displacement and base moment of the two; draw the moment."""
    tree = grow('pine', HEIGHT, rng=np.random.default_rng(4))
    rng = np.random.default_rng(5)
    wind = simulate_turbulence(SPEED, rate=RATE, duration=60.0, rng=rng)
    print(f'a pine of {HEIGHT:g} m, {SPEED:g} m/s at its top')
    axes = (figure := Figure(figsize=(7, 4), layout='constrained')).subplots()
    for name, profile in profiles().items():
        record = simulate(tree, wind, rate=RATE, profile=profile)
        tip = np.linalg.norm(record.tips[:, 0], axis=1)
        moment = np.linalg.norm(record.base_moment, axis=1)
        print(f'{name:10} tip {tip.mean():.3f} m (largest {tip.max():.3f}), base moment '
              f'{moment.mean() / 1e3:.2f} kN m (largest {moment.max() / 1e3:.2f})')  # fmt: skip
        axes.plot(record.time, moment / 1e3, label=name)
    axes.set(xlabel='time [s]', ylabel='base moment [kN m]', title='a pine of 12 m')
    axes.legend()
    return figure


if __name__ == '__main__':
    main()
