# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Make `spectra.csv` with PyConTurb (J. Rinker, DTU, MIT licence), an independent generator.

    python -m pip install pyconturb==2.7.4 && python make_spectra.py > spectra.csv

One hour at 20 Hz, 7 m/s at 10 m, IEC class B, Kaimal: for each frequency the closed form of
PyConTurb and the Welch estimate of its record, of u, v, w, both in m^2/s^2/Hz. Takes some minutes.
"""

from itertools import pairwise

import numpy as np
import pandas as pd
from pyconturb import gen_turb
from pyconturb.sig_models import iec_sig
from pyconturb.spectral_models import kaimal_spectrum
from pyconturb.wind_profiles import constant_profile
import scipy.signal

RATE, DURATION = 20.0, 3600.0
CASE = {'u_ref': 7.0, 'z_ref': 10.0, 'turb_class': 'B'}


def main() -> None:
    """Print the table."""
    points = pd.DataFrame(
        [[0, 1, 2], [0, 0, 0], [0, 0, 0], [10, 10, 10]], index=['k', 'x', 'y', 'z']
    )
    points.columns = ['u_p0', 'v_p0', 'w_p0']
    record = gen_turb(
        points, T=DURATION, dt=1.0 / RATE, seed=1, wsp_func=constant_profile, verbose=False, **CASE
    )
    frequency, estimate = scipy.signal.welch(record.to_numpy(), RATE, nperseg=4096, axis=0)
    closed = kaimal_spectrum(frequency, points, **CASE) * iec_sig(points, **CASE) ** 2
    print('frequency,closed_u,closed_v,closed_w,record_u,record_v,record_w')
    edges = np.geomspace(0.02, 9.5, 25)
    for low, high in pairwise(edges):
        band = (frequency >= low) & (frequency < high)
        if band.any():
            row = [
                frequency[band].mean(),
                *closed[band].mean(axis=0),
                *estimate[band].mean(axis=0),
            ]
            print(','.join(f'{value:.6e}' for value in row))


if __name__ == '__main__':
    main()
