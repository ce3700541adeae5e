# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From measured sway to frequency, damping and a calibrated tree.

Free decay, spectra, the fit.
Reading files is not done here.
"""
