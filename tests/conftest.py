"""No test measures time: random examples have no deadline either."""

import os

from hypothesis import settings

settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

# a width in the environment (pytest-xdist sets one) is asked of every output, by contract
os.environ.pop("COLUMNS", None)
