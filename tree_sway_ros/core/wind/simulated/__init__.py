"""
Winds that no sensor measured: turbulence of a given spectrum, gust events, a simulated anemometer.

Randomness comes from an ``rng`` argument.
What a recorded wind needs lives one room up.

"""
