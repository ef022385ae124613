"""Explorations by many analyses: sweeps, sizes, weights, probabilities, charts."""
