"""For all tests: Hypothesis draws the same cases in every run, and more of them when asked to."""

import os

from hypothesis import settings

# The same commit passes or fails alike everywhere; HYPOTHESIS_PROFILE=explore looks further.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))
