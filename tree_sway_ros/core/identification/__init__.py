"""
From measured sway to frequency, damping and a calibrated tree.

Free decay, ambient sway, spectra, the fit.
Reading files is not done here.

"""
