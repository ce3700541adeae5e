"""For all tests: Hypothesis draws the same cases in every run, and more of them when asked to; one thread a test."""

import os

# Before numpy is loaded: matrices here are small, and idle threads of BLAS that spin slow down the test beside.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import settings

# The same commit passes or fails alike everywhere; HYPOTHESIS_PROFILE=explore looks further.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))
